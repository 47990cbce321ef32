/** What is shown: the grid, the robot's layers (shared by all), and its links (each person's own view). */

/** @import { LinkRow } from "../../lib/tree.js" */
/** @import { Row } from "./tree.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { groupsTo } from "../../lib/display-groups.js";
import { t } from "../../lib/i18n.js";
import { addedDisplay } from "../../lib/live-displays.js";
import { shownNumber } from "../../lib/numbers.js";
import { baseName, shortPath } from "../../lib/paths.js";
import { whenPlaced } from "../../lib/seen.js";
import { ancestorsOf, linkRows, withoutInertia } from "../../lib/tree.js";
import { EmptyState, IconButton, SearchBox } from "../../lib/ui.js";
import { displays, documentState, links, problems, robot } from "../../model/document.js";
import { liveDisplays } from "../../model/live-displays.js";
import { setDisplay } from "../../model/requests.js";
import {
  fadeLink,
  hiddenLinks,
  linkOpacity,
  onlySelected,
  selected,
  selection,
  selectPart,
  showLink,
} from "../../model/selection.js";
import { tellIn } from "../../model/tf.js";
import { focusLink } from "../../model/viewport.js";
import { onResetKey, PlaceLink } from "../parts.js";
import { globalRows, ResetButton, robotTrouble } from "./global-rows.js";
import {
  AddDisplayButton,
  AllDisplaysButton,
  dropTopic,
  liveRows,
  setLiveOpen,
  takeTopic,
} from "./live-rows.js";
import { rowId, Tree } from "./tree.js";

/** Settings from 0 to 1. */
const SHARES = new Set(["opacity"]);

export function DisplaysPanel() {
  const filter = useSignal("");
  const closed = useSignal(/** @type {ReadonlySet<string>} */ (new Set(["grid", "layers"])));
  const active = useSignal("robot");
  const rows = treeRows(filter.value, closed.value);
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  useRevealSelection(closed, panel);
  useRevealAdded(filter, closed, active, panel);
  /** @param {string} id @param {boolean} open */
  const setOpen = (id, open) => {
    if (setLiveOpen(id, open)) return;
    const now = new Set(closed.value);
    if (open) now.delete(id);
    else now.add(id);
    closed.value = now;
  };
  return html`<section ref=${panel} class="panel-body" aria-label=${t("panel.displays")} onDragOver=${takeTopic} onDrop=${dropTopic}
    onKeyDown=${onResetKey}>
    <div class="panel-bar of-displays">
      <${SearchBox} label=${t("displays.filter")} value=${filter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        filter.value = text;
      }} />
      <${AllDisplaysButton} />
      <${ResetButton} />
      <${AddDisplayButton} />
    </div>
    ${rows.length === 0 && filter.value === "" && html`<${EmptyState} icon="robot" title=${t("urdf.none")} />`}
    ${rows.length > 0 && html`<${Tree} rows=${rows} active=${active} setOpen=${setOpen} />`}
    ${rows.length === 0 && filter.value !== "" && html`<p class="nothing">${t("filter.nothing", { words: filter.value })}</p>`}
    <${RowHelp} row=${rows.find(({ id }) => id === active.value)} />
    <${LinkDetails} />
  </section>`;
}

/** After a click: what comes and goes below the tree must not move it between press and release. */
const HELP_AFTER_MS = 200;
const NO_HELP = { title: "", text: "" };

/** What the current row is, as RViz says it below its tree. @param {{row: Row | undefined}} props */
function RowHelp({ row }) {
  const said = useSignal(NO_HELP);
  const help = row?.help ?? NO_HELP;
  useEffect(() => {
    const later = setTimeout(() => {
      said.value = help;
    }, HELP_AFTER_MS);
    return () => clearTimeout(later);
  }, [row?.id, help.text]);
  const { title, text } = said.value;
  if (text === "") return null;
  return html`<aside class="row-help" aria-live="polite" aria-label=${t("displays.help")}><strong>${title}</strong><p>${text}</p></aside>`;
}

/** A link selected elsewhere is unfolded and scrolled to; one selected here stays in view above its details. @param {{value: ReadonlySet<string>}} closed @param {{current: HTMLElement | null}} panel */
function useRevealSelection(closed, panel) {
  const link = selected.value;
  useEffect(() => {
    if (!link || !robot.value) return undefined;
    const reveal = () =>
      requestAnimationFrame(() => {
        document.getElementById(rowId(`link:${link}`))?.scrollIntoView({ block: "nearest" });
      });
    if (selection.value?.by === "displays") {
      const asked = reveal();
      return () => cancelAnimationFrame(asked);
    }
    const way = ["robot", "links", ...ancestorsOf(robot.value, link).map((name) => `link:${name}`)];
    closed.value = new Set([...closed.value].filter((id) => !way.includes(id)));
    return whenPlaced(panel.current, reveal);
  }, [link]);
}

/**
 * A display that is added, here or from another panel, is in sight: its group is unfolded, a filter that hides it is emptied.
 * @param {{value: string}} filter @param {{value: ReadonlySet<string>}} closed @param {{value: string}} active @param {{current: HTMLElement | null}} panel
 */
function useRevealAdded(filter, closed, active, panel) {
  const list = liveDisplays.value;
  const known = useRef(/** @type {ReadonlySet<string> | null} */ (null));
  useEffect(() => {
    const before = known.current;
    known.current = new Set(list.map(({ id }) => id));
    const added = addedDisplay(before, list);
    if (!added) return undefined;
    const row = `display:${added.id}`;
    const around = groupsTo(added.group).map((group) => `group:${group}`);
    closed.value = new Set([...closed.value].filter((id) => !around.includes(id)));
    if (!liveRows(filter.value, closed.value).some(({ id }) => id === row)) filter.value = "";
    active.value = row; // so that it is drawn, however far away it is
    return whenPlaced(panel.current, () =>
      requestAnimationFrame(() =>
        document.getElementById(rowId(row))?.scrollIntoView({ block: "nearest" }),
      ),
    );
  }, [list]);
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function treeRows(filter, closed) {
  return [
    ...globalRows(filter, closed),
    ...gridRows(filter, closed),
    ...robotRows(filter, closed),
    ...liveRows(filter, closed),
  ];
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function robotRows(filter, closed) {
  const settings = displays.value.robot;
  if (!settings && !robot.value) return [];
  const below = [...robotTrouble(), ...layerRows(filter, closed), ...treeOfLinks(filter, closed)];
  if (below.length === 0 && !hit(t("display.robot"), filter)) return [];
  const open = filter !== "" || !closed.has("robot");
  const count = robot.value?.links.length ?? 0;
  /** @type {Row} */
  const head = {
    id: "robot",
    level: 1,
    label: t("display.robot"),
    icon: "robot",
    expandable: true,
    expanded: open,
    meta: count > 0 ? t("links.count", { count }) : "",
    ...eyeOf("robot", settings && "visible" in settings ? "visible" : "visual"),
  };
  return [head, ...(open ? below : [])];
}

/** @param {string} text @param {string} filter */
const hit = (text, filter) => text.toLowerCase().includes(filter.trim().toLowerCase());

/** @param {"grid" | "robot"} display @param {string} name @returns {Pick<Row, "eye">} its switch, when it has one */
function eyeOf(display, name) {
  const value = displays.value[display]?.[name];
  if (typeof value !== "boolean") return {};
  const label = t("display.show", { name: settingLabel(display, name) });
  const set = (/** @type {boolean} */ on) => void setDisplay(display, name, on);
  return { eye: { on: value, label, set, shared: true } };
}

/** @param {string} display @param {string} name @returns {string} words for a setting, known or not */
function settingLabel(display, name) {
  const key = `display.${display}.${name}`;
  const words = t(key);
  return words === key ? name.replaceAll("_", " ") : words;
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function gridRows(filter, closed) {
  const settings = displays.value.grid;
  if (!settings) return [];
  const below = settingRows("grid", 2, filter);
  if (below.length === 0 && !hit(t("display.grid"), filter)) return [];
  const open = filter !== "" || !closed.has("grid");
  const cell = settings.cell_m;
  /** @type {Row} */
  const head = {
    id: "grid",
    level: 1,
    label: t("display.grid"),
    icon: "grid",
    expandable: below.length > 0,
    expanded: open,
    meta: typeof cell === "number" ? `${shownNumber(cell)} m` : "",
    ...eyeOf("grid", "visible"),
  };
  return [head, ...(open ? below : [])];
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function layerRows(filter, closed) {
  const below = settingRows("robot", 3, filter);
  if (below.length === 0) return [];
  const open = filter !== "" || !closed.has("layers");
  const on = below.filter(({ eye }) => eye?.on).map(({ label }) => label);
  /** @type {Row} */
  const head = {
    id: "layers",
    level: 2,
    label: t("display.layers"),
    icon: "layout",
    expandable: true,
    expanded: open,
    meta: open ? "" : on.join(", "),
  };
  return [head, ...(open ? below : [])];
}

/** @param {"grid" | "robot"} display @param {number} level @param {string} filter @returns {Row[]} */
function settingRows(display, level, filter) {
  return Object.entries(displays.value[display] ?? {})
    .filter(([name]) => name !== "visible" && hit(settingLabel(display, name), filter))
    .map(([name, value]) => settingRow(display, name, value, level));
}

/** @param {"grid" | "robot"} display @param {string} name @param {boolean | number | string} value @param {number} level @returns {Row} */
function settingRow(display, name, value, level) {
  const label = settingLabel(display, name);
  const row = { id: `${display}.${name}`, level, label, icon: "" };
  if (typeof value === "boolean") return { ...row, ...eyeOf(display, name) };
  if (typeof value === "string") return { ...row, meta: value };
  const set = (/** @type {number} */ one) => void setDisplay(display, name, one);
  if (SHARES.has(name)) return { ...row, slider: { value, label, set } };
  return { ...row, number: { value, label, set, unit: name.endsWith("_m") ? "m" : "" } };
}

/** @param {string} filter @param {ReadonlySet<string>} closed @returns {Row[]} */
function treeOfLinks(filter, closed) {
  const folded = new Set(
    [...closed].filter((id) => id.startsWith("link:")).map((id) => id.slice(5)),
  );
  return linkRows(links.value, folded, filter, 2).map(linkRow);
}

/** @param {LinkRow} row @returns {Row} */
function linkRow({ node, level, expandable, expanded }) {
  const { name } = node.link;
  const visible = !hiddenLinks.value.has(name);
  const massless = withoutInertia(problems.value).has(name);
  return {
    id: `link:${name}`,
    level,
    label: name,
    icon: "box",
    expandable,
    expanded,
    link: name,
    meta: massless ? t("link.no_inertia") : "",
    warn: massless,
    eye: {
      on: visible,
      label: t("display.show", { name }),
      set: (on) => showLink(name, on),
      shared: false,
    },
  };
}

/** What is known of the selected link, below the tree; its opacity is this person's own. */
function LinkDetails() {
  const link = robot.value?.links.find(({ name }) => name === selected.value);
  if (!link) return null;
  const joint = robot.value?.joints.find(({ child }) => child === link.name);
  const close = () => {
    selected.value = null;
  };
  return html`<aside class="details" aria-label=${t("link.details", { name: link.name })}>
    <header><strong><button type="button" class="text-button" title=${`${link.name}\n${t("origin.show")}`}
        onClick=${() => explain(`link:${link.name}`)}>${link.name}</button></strong>
      <span class="details-buttons"><${IconButton} icon="fit" label=${t("link.focus")} onClick=${() => focusLink(link.name)} />
      <${IconButton} icon="properties" label=${t("link.values")} onClick=${showValues} />
      <${IconButton} icon="frames" label=${t("link.tell_in")} onClick=${() => tellIn(link.name)} />
      <${IconButton} icon="close" label=${t("link.deselect")} onClick=${close} /></span>
    </header>
    <dl>
      ${joint && html`<dt>${t("link.joint")}</dt><dd><button type="button" class="text-button" title=${t("origin.show")} onClick=${() => explain(`joint:${joint.name}`)}>${joint.name}</button> <span class="muted">${t(`joint.${joint.type}`)}</span></dd>`}
      ${joint?.mimic && html`<dt>${t("joint.mimic")}</dt><dd>${joint.mimic}</dd>`}
      <dt>${t("link.mass")}</dt><dd title=${link.mass_kg}>${link.mass_kg === null ? t("link.no_inertia") : `${shownNumber(link.mass_kg)} kg`}</dd>
      <dt>${t("link.shapes")}</dt><dd>${t("link.shapes.text", { visuals: link.visuals, collisions: link.collisions })}</dd>
      ${link.meshes.length > 0 && html`<dt>${t("link.meshes")}</dt><dd>${link.meshes.map((uri) => html`<span class="line" title=${uri}>${baseName(uri)}</span>`)}</dd>`}
      ${link.file && html`<dt>${t("link.place")}</dt><dd title=${shortPath(link.file, documentState.value?.root ?? "")}><${PlaceLink} place=${{ file: link.file, line: link.line ?? 0, column: 1 }} /></dd>`}
      ${link.macros.length > 0 && html`<dt>${t("link.macros")}</dt><dd>${link.macros.join(" › ")}</dd>`}
      <dt>${t("link.opacity")}</dt><dd><${Opacity} link=${link.name} /></dd>
    </dl>
  </aside>`;
}

function showValues() {
  onlySelected.value = true;
  commandById("panel.properties")?.run();
}

/** @param {string} part say where it comes from */
function explain(part) {
  selectPart(part, "", "", "displays");
  commandById("panel.origin")?.run();
}

/** @param {{link: string}} props */
function Opacity({ link }) {
  const value = linkOpacity.value.get(link) ?? 1;
  return html`<input type="range" class="slider" min="0" max="1" step="0.05" value=${value} style=${`--fill:${value * 100}%`}
    aria-label=${t("link.opacity.of", { name: link })} title=${t("only_here")}
    onInput=${(/** @type {any} */ event) => fadeLink(link, Number(event.currentTarget.value))} />`;
}
