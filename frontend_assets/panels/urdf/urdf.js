/** The URDF that the xacro came to, and what the unsaved edits change in it. Fetched when it is looked at. */

/** @import { UrdfChanges } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { commandById } from "../../lib/commands.js";
import { language, t } from "../../lib/i18n.js";
import { EmptyState, Icon, IconButton, ProgressBar, Segments } from "../../lib/ui.js";
import { askOrKeepWhy } from "../../model/asking.js";
import { connection } from "../../model/connection.js";
import { built, history, robot, title } from "../../model/document.js";
import { selection, selectPart } from "../../model/selection.js";
import { notify } from "../../model/view.js";
import { Refusal } from "../parts.js";
import { UrdfText } from "./text.js";

const SETTLE_MS = 250;

export function UrdfPanel() {
  const text = useSignal("");
  const onlyChanges = useSignal(false);
  const changes = useSignal(/** @type {UrdfChanges | null} */ (null));
  const view = useRef(/** @type {UrdfText | null} */ (null));
  const refused = useSignal("");
  const tries = useSignal(0);
  useFresh(text, onlyChanges.value ? changes : null, refused, tries.value);
  const again = () => {
    tries.value += 1;
  };
  if (!text.value) {
    return html`<section class="panel-body" aria-label=${t("panel.urdf")}>
      ${
        robot.value && refused.value
          ? html`<${Refusal} sentence=${refused.value} again=${again} />`
          : html`<${EmptyState} icon="urdf" title=${robot.value ? t("loading") : t("urdf.none")} />`
      }</section>`;
  }
  return html`<section class="panel-body" aria-label=${t("panel.urdf")}>
    <${Bar} text=${text.value} onlyChanges=${onlyChanges} changes=${changes.value} find=${() => view.current?.find()} />
    ${
      onlyChanges.value && !changes.value && refused.value
        ? html`<${Refusal} sentence=${refused.value} again=${again} />`
        : html`<${Body} text=${text.value} changes=${onlyChanges.value ? changes.value : undefined} view=${view} />`
    }
  </section>`;
}

/** @param {{text: string, onlyChanges: {value: boolean}, changes: UrdfChanges | null, find: () => void}} props */
function Bar({ text, onlyChanges, changes, find }) {
  const copy = async () => {
    if (await copyText(text)) notify(t("copied"));
  };
  return html`<div class="panel-bar row urdf-bar">
    <${Segments} label=${t("urdf.view")} chosen=${onlyChanges} of=${[
      [false, t("urdf.all")],
      [true, t("urdf.changes")],
    ]} />
    <span class="muted numbers urdf-count">${countWords(text, onlyChanges.value, changes)}</span>
    <span class="push"></span>
    <${IconButton} icon="search" label=${t("urdf.find")} onClick=${find} />
    <button type="button" class="button small" onClick=${copy}><${Icon} name="copy" size=${14} />${t("copy")}</button>
    <button type="button" class="button small" onClick=${() => download(text)}><${Icon} name="download" size=${14} />${t("download")}</button>
  </div>`;
}

/** @param {string} text @param {boolean} onlyChanges @param {UrdfChanges | null} changes @returns {string} */
function countWords(text, onlyChanges, changes) {
  if (!onlyChanges) return t("urdf.lines", { count: text.trimEnd().split("\n").length });
  if (!changes) return "";
  const { added, removed, left_out: count } = changes;
  const words = [t("urdf.differs", { added, removed })];
  if (count > 0) words.push(t("urdf.left_out", { count }));
  return words.join(" · ");
}

/**
 * @param {{text: string, changes: UrdfChanges | null | undefined, view: {current: UrdfText | null}}} props
 *   `changes` undefined: the whole is shown; null: they are not known yet
 */
function Body({ text, changes, view }) {
  const host = useRef(/** @type {HTMLElement | null} */ (null));
  const elements = useMemo(() => elementsByLine(text.split("\n")), [text]);
  const known = useRef(elements);
  known.current = elements;
  const words = language.value;
  useEffect(() => {
    if (!host.current) return undefined;
    view.current = new UrdfText(host.current, (line, column) =>
      choose(known.current, view, line, column),
    );
    return () => {
      view.current?.destroy();
      view.current = null;
    };
  }, [words]);
  useEffect(() => {
    if (changes === undefined) view.current?.showText(text.trimEnd());
    else if (changes) view.current?.showChanges(changes);
  }, [text, changes, words]);
  useChosenLine(host, view, elements, changes === undefined);
  const empty = emptyWords(changes);
  return html`<div class="source-editor urdf-body" ref=${host} title=${changes === undefined ? t("urdf.where") : ""} hidden=${empty !== "" || changes === null}></div>
    ${changes === null && html`<${ProgressBar} label=${t("urdf.comparing")} done=${0} total=${0} />`}
    ${empty && html`<${EmptyState} icon=${changes?.fault ? "alert" : "check"} title=${empty} />`}`;
}

/** @param {UrdfChanges | null | undefined} changes @returns {string} why there are no lines to show */
function emptyWords(changes) {
  if (!changes || changes.hunks.length > 0) return "";
  if (changes.fault) return changes.fault;
  const isSaved = history.value.unsaved_files.length === 0;
  return t(isSaved ? "urdf.nothing_unsaved" : "urdf.no_changes");
}

/** An element leads to where it comes from. @param {ReturnType<typeof elementsByLine>} elements @param {{current: UrdfText | null}} view @param {number} line from 0 @param {number} column */
function choose(elements, view, line, column) {
  const found = elements.get(line);
  if (!found) return;
  const text = view.current?.view.state.doc.line(line + 1).text ?? "";
  selectPart(found.part, found.element, attributeAt(text, column), "urdf");
  commandById("panel.origin")?.run();
}

/** @param {string} line @param {number} column @returns {string} the attribute that is written there */
function attributeAt(line, column) {
  for (const { 0: whole, 1: name = "", index } of line.matchAll(/([\w:.-]+)="[^"]*"/g))
    if (index <= column && column <= index + whole.length) return name;
  return "";
}

/**
 * The line of the chosen element is marked and in view.
 *
 * @param {{current: HTMLElement | null}} host
 * @param {{current: UrdfText | null}} view
 * @param {ReturnType<typeof elementsByLine>} elements
 * @param {boolean} isWhole
 */
function useChosenLine(host, view, elements, isWhole) {
  const lines = useMemo(() => {
    const entries = [...elements].map(([line, one]) => [`${one.part} ${one.element}`, line]);
    return new Map(/** @type {[string, number][]} */ (entries));
  }, [elements]);
  const { part, element } = selection.value ?? {};
  const line = lines.get(`${part} ${element ?? ""}`) ?? -1;
  useEffect(() => {
    if (!isWhole) return undefined;
    return whenInView(host.current, () => view.current?.light(line));
  }, [line, elements, isWhole]);
}

/** Once, and not before the panel is looked at. @param {Element | null} element @param {() => void} run @returns {() => void} the end of waiting */
function whenInView(element, run) {
  const watcher = new IntersectionObserver((entries) => {
    if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
    watcher.disconnect();
    run();
  });
  if (element) watcher.observe(element);
  return () => watcher.disconnect();
}

/**
 * Asks again after every good run, but not at every step of a drag.
 *
 * @param {Signal<string>} text
 * @param {Signal<UrdfChanges | null> | null} changes null: nobody looks at them
 * @param {Signal<string>} refused why nothing was told
 * @param {number} tries another number asks again, too
 */
function useFresh(text, changes, refused, tries) {
  const run = built.value;
  const unsaved = history.value;
  const there = connection.value === "connected" && robot.value !== null;
  useEffect(() => {
    if (!there) return undefined;
    let isOld = false;
    const later = setTimeout(
      async () => {
        const answer = await askOrKeepWhy({ type: "get_urdf" }, refused);
        if (!isOld && answer?.type === "urdf") text.value = answer.text;
        if (!changes || isOld) return;
        const found = await askOrKeepWhy({ type: "get_urdf_changes" }, refused);
        if (!isOld && found?.type === "urdf_changes") changes.value = found;
      },
      text.value ? SETTLE_MS : 0,
    );
    return () => {
      isOld = true;
      clearTimeout(later);
    };
  }, [run, unsaved, there, changes !== null, tries]);
}

/** @param {string} text */
function download(text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/xml" }));
  link.download = `${title.value.replace(/(\.urdf)?(\.xacro)?$/, "") || "robot"}.urdf`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** @typedef {{part: string, element: string}} ElementOfPart a part's key, and the path inside it; empty: the part itself */
/** @typedef {{tag: string, name: string | null, line: number, children: UrdfElement[]}} UrdfElement */

const TAG = /<(\/?)([\w:.-]+)((?:\s+[\w:.-]+\s*=\s*"[^"]*")*)\s*(\/?)>/g;
const NAME = /\sname="([^"]*)"/;
const NAMED = new Set(["link", "joint", "material"]);
/** @type {Record<string, string>} */
const ENTITIES = { lt: "<", gt: ">", amp: "&", quot: '"', apos: "'" };

/**
 * Which part and element of the robot each line of its URDF begins, in the layout that the studio
 * writes.
 *
 * @param {readonly string[]} lines
 * @returns {Map<number, ElementOfPart>} by line, from 0
 */
export function elementsByLine(lines) {
  /** @type {Map<number, ElementOfPart>} */
  const found = new Map();
  for (const [key, part] of keyed(elementsOf(lines)?.children ?? [])) walk(key, "", part, found);
  return found;
}

/** @param {readonly string[]} lines @returns {UrdfElement | undefined} the root */
function elementsOf(lines) {
  /** @type {UrdfElement} */
  const all = { tag: "", name: null, line: -1, children: [] };
  const open = [all];
  lines.forEach((text, line) => {
    for (const found of text.matchAll(TAG)) take(open, found, line);
  });
  return all.children[0];
}

/** @param {UrdfElement[]} open around the tag, the root's parent first @param {RegExpMatchArray} found @param {number} line */
function take(open, [, isEnd, tag = "", attributes = "", isWhole], line) {
  if (isEnd) {
    if (open.length > 1) open.pop();
    return;
  }
  const name = NAME.exec(attributes)?.[1];
  const element = { tag, name: name === undefined ? null : plain(name), line, children: [] };
  open.at(-1)?.children.push(element);
  if (!isWhole) open.push(element);
}

/** @param {readonly UrdfElement[]} parts @returns {[string, UrdfElement][]} with their keys, as the studio names parts */
function keyed(parts) {
  /** @type {Map<string, number>} */
  const used = new Map();
  let others = 0;
  return parts.map((part) => {
    const named = NAMED.has(part.tag) && part.name !== null;
    const key = named ? `${part.tag}:${part.name}` : `other:${others}`;
    if (!named) others += 1;
    const count = (used.get(key) ?? 0) + 1;
    used.set(key, count);
    return [count === 1 ? key : `${key}#${count}`, part];
  });
}

/** @param {string} part @param {string} path @param {UrdfElement} element @param {Map<number, ElementOfPart>} found */
function walk(part, path, element, found) {
  found.set(element.line, { part, element: path });
  /** @type {Map<string, number>} */
  const seen = new Map();
  for (const child of element.children) {
    const number = (seen.get(child.tag) ?? 0) + 1;
    seen.set(child.tag, number);
    const several = element.children.filter(({ tag }) => tag === child.tag).length > 1;
    const step = several ? `${child.tag}[${number}]` : child.tag;
    walk(part, path ? `${path}/${step}` : step, child, found);
  }
}

/** @param {string} text of an attribute @returns {string} without references */
function plain(text) {
  return text.replace(/&(\w+);/g, (whole, name) => ENTITIES[name] ?? whole);
}
