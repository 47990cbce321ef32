/** Which pages the help has beside one for each panel. */

/** Pages that are not about one panel, with their icons, by the heading above them. */
const OTHERS = {
  tasks: {
    open: "open",
    arguments: "sliders",
    saving: "disk",
    export: "download",
    measuring: "measure",
    search: "search",
    ros: "link",
    live: "radar",
    keys: "keyboard",
    layouts: "layout",
    graphics: "system",
  },
  words: { xacro: "macro", links: "joints", frame: "axes", units: "info" },
};
export const OTHER_PAGES = {
  tasks: Object.keys(OTHERS.tasks),
  words: Object.keys(OTHERS.words),
};
/** Icons of these pages. @type {Record<string, string>} */
export const ICON_OF = { ...OTHERS.tasks, ...OTHERS.words };
/** The page about each window that has a head; the search finds its own help. @type {Record<string, string>} */
export const OF_DIALOG = {
  open: "open",
  choose_package: "open",
  launch: "arguments",
  save: "saving",
  save_as: "saving",
  merge: "saving",
  share: "export",
  keys: "keys",
  layouts: "layouts",
  graphics: "graphics",
  ros: "ros",
  add_display: "live",
};
