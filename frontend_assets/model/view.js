/**
 * What is this person's own: theme, units, the window that is open, notices. Nothing of it is
 * shared.
 */

/** @import { Signal } from "vendor/preact.js" */

import { computed, signal } from "vendor/preact.js";
import { remembered } from "../lib/remembered.js";

/** @param {string[]} choices @returns {(value: unknown) => boolean} */
const oneOf = (choices) => (value) => choices.includes(/** @type {string} */ (value));

const systemDark = matchMedia("(prefers-color-scheme: dark)");
const systemTheme = signal(systemDark.matches ? "dark" : "light");
systemDark.addEventListener("change", (event) => {
  systemTheme.value = event.matches ? "dark" : "light";
});

/** @type {Signal<"system" | "dark" | "light">} */
export const themeChoice = remembered(
  "theme",
  /** @type {"system" | "dark" | "light"} */ ("system"),
  oneOf(["system", "dark", "light"]),
);
export const theme = computed(
  () =>
    /** @type {"dark" | "light"} */ (
      themeChoice.value === "system" ? systemTheme.value : themeChoice.value
    ),
);
export const degrees = remembered("degrees", false);
/** @type {Signal<"rviz" | "trackpad">} */
export const mouseMode = remembered(
  "mouse",
  /** @type {"rviz" | "trackpad"} */ ("rviz"),
  oneOf(["rviz", "trackpad"]),
);
/** Empty: the browser's language. @type {Signal<string>} */
export const languageChoice = remembered("language", "");

/** What the properties are filtered by; the palette and other panels set it too. */
export const propertyFilter = signal("");
/** Site whose row comes into view and takes the focus next. @type {Signal<string | null>} */
export const soughtSite = signal(null);

/** @type {Signal<"wide" | "medium" | "phone">} */
export const size = signal("wide");

/** Whether the 3D view is all that is seen, as RViz's full screen. */
export const fullView = signal(new URLSearchParams(globalThis.location?.search).has("fullscreen"));

/** @typedef {"recent" | "browse" | "examples" | "new" | "paste" | "ros"} OpenTab */
/** @typedef {{kind: "open", tab?: OpenTab} | {kind: "save_as"} | {kind: "choose_package", name: string} | {kind: "launch", path: string} | {kind: "merge", file: string} | {kind: "share", link: import("../types/wire.d.ts").Link} | {kind: "save"} | {kind: "keys"} | {kind: "class"} | {kind: "class_name"} | {kind: "nodes"} | {kind: "remark", document: string} | {kind: "layouts"} | {kind: "new_package"} | {kind: "add_to_package", what: import("../types/wire.d.ts").AddToPackage["what"], folder: string, name: string} | {kind: "graphics"} | {kind: "ros"} | {kind: "add_display"} | {kind: "palette"} | {kind: "rviz_open"} | {kind: "rviz_save"} | {kind: "rviz_opened", opened: import("../types/wire.d.ts").RvizConfigOpened} | {kind: "confirm", title: string, text: string, details?: readonly string[], action: string, danger?: boolean, run: () => void, other?: {action: string, run: () => void}}} Shown */
/** The one window over the page. @type {Signal<Shown | null>} */
export const dialog = signal(null);
/** No window waits for an answer; the palette is gone before what it found begins. */
export const isFree = () => dialog.value === null || dialog.value.kind === "palette";

/** @typedef {{label: string, run: () => void}} NoticeAction what a click on it does, as to take back what was done */
/** @typedef {{id: number, text: string, bad: boolean, action: NoticeAction | null}} Notice */
/** @type {Signal<readonly Notice[]>} */
export const notices = signal([]);
let noticeCount = 0;

/**
 * Show a sentence for some seconds; what wants a decision, or is long to read, for longer.
 *
 * @param {string} text
 * @param {{bad?: boolean, long?: boolean, action?: NoticeAction}} [options]
 */
export function notify(text, { bad = false, long = false, action } = {}) {
  noticeCount += 1;
  const id = noticeCount;
  notices.value = [
    ...notices.value.filter((one) => one.text !== text).slice(-2),
    { id, text, bad, action: action ?? null },
  ];
  setTimeout(() => dismiss(id), bad || long || action ? 9000 : 3500);
}

/** @param {number} id of a notice */
export function dismiss(id) {
  notices.value = notices.value.filter((one) => one.id !== id);
}

/** Full name of a node that the node graph is to show; empty: none. @type {Signal<string>} */
export const soughtNode = signal("");

/** Id of the panel that was shown or clicked last. @type {Signal<string | null>} */
export const activePanel = signal(null);

/**
 * @typedef {object} LayoutControl
 * @property {() => import("../lib/arrangement.js").Arrangement} present how the panels stand now
 * @property {(name: string) => void} use a layout; the empty name is the studio's own
 * @property {(id: string, other: string) => void} showBeside a panel, with another one kept in sight
 * @property {(ids: readonly string[]) => void} open panels that are missing, behind the others
 * @property {() => void} reset to the layout in use as it was saved
 * @property {(arrangement: import("../lib/arrangement.js").Arrangement) => void} arrange the panels so, as a file says
 */

/** What arranges the dock; null until it stands. @type {Signal<LayoutControl | null>} */
export const layoutControl = signal(null);
