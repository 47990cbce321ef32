/** The URDF that the xacro came to, as text to read, copy and keep. It is fetched when it is looked at. */

import { html, useEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { commandById } from "../app/commands.js";
import { connection } from "../app/state/connection.js";
import { built, robot, title } from "../app/state/document.js";
import { selection, selectPart } from "../app/state/selection.js";
import { notify } from "../app/state/view.js";
import { send } from "../app/wire.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { EmptyState, Icon } from "../lib/ui.js";
import { elementsByLine } from "../lib/urdf-elements.js";

const SETTLE_MS = 250;

export function UrdfPanel() {
  const text = useSignal("");
  useFresh(text);
  if (!text.value) {
    return html`<section class="panel-body" aria-label=${t("panel.urdf")}>
      <${EmptyState} icon="urdf" title=${robot.value ? t("loading") : t("urdf.none")} /></section>`;
  }
  const lines = text.value.trimEnd().split("\n");
  const copy = async () => {
    if (await copyText(text.value)) notify(t("copied"));
  };
  return html`<section class="panel-body" aria-label=${t("panel.urdf")}>
    <div class="panel-bar row">
      <span class="muted numbers">${t("urdf.lines", { count: lines.length })}</span>
      <span class="push"></span>
      <button type="button" class="button small" onClick=${copy}><${Icon} name="copy" size=${14} />${t("copy")}</button>
      <button type="button" class="button small" onClick=${() => download(text.value)}><${Icon} name="download" size=${14} />${t("download")}</button>
    </div>
    <${Lines} lines=${lines} text=${text.value} />
  </section>`;
}

/** @param {{lines: string[], text: string}} props each element leads to where it comes from */
function Lines({ lines, text }) {
  const pre = useRef(/** @type {HTMLElement | null} */ (null));
  // Thousands of lines: drawn once for a text, not anew at every choice.
  const drawn = useMemo(() => lines.map(drawnLine), [text]);
  const elements = useMemo(() => elementsByLine(lines), [text]);
  useChosenLine(pre, elements);
  /** @param {MouseEvent} event */
  const choose = (event) => {
    const target = event.target instanceof Element ? event.target : null;
    const line = Number(target?.closest("code")?.dataset.line) - 1;
    const found = elements.get(line);
    if (!found || getSelection()?.isCollapsed === false) return;
    selectPart(found.part, found.element, attributeAt(target), "urdf");
    commandById("panel.origin")?.run();
  };
  return html`<pre ref=${pre} class="code scroll" tabindex="0" aria-label=${t("panel.urdf")} title=${t("urdf.where")}
    onClick=${choose}>${drawn}</pre>`;
}

/** @param {string} line @param {number} at */
function drawnLine(line, at) {
  return html`<code key=${at} data-line=${at + 1}>${coloured(line)}</code>`;
}

/** The line of the chosen element is marked and in view. @param {{current: HTMLElement | null}} pre @param {ReturnType<typeof elementsByLine>} elements */
function useChosenLine(pre, elements) {
  const lines = useMemo(() => {
    const entries = [...elements].map(([line, one]) => [`${one.part} ${one.element}`, line]);
    return new Map(/** @type {[string, number][]} */ (entries));
  }, [elements]);
  const { part, element } = selection.value ?? {};
  const line = lines.get(`${part} ${element}`);
  useEffect(() => {
    const code = pre.current?.querySelector(`[data-line="${(line ?? -1) + 1}"]`);
    if (!code) return undefined;
    code.classList.add("chosen");
    const shown = whenInView(pre.current, () => scrollTo(code));
    return () => {
      shown();
      code.classList.remove("chosen");
    };
  }, [line, elements]);
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

/** A line in view stays where it is. @param {Element} code */
function scrollTo(code) {
  const around = code.parentElement?.getBoundingClientRect();
  const { top, bottom } = code.getBoundingClientRect();
  if (around && (top < around.top || bottom > around.bottom))
    code.scrollIntoView({ block: "center" });
}

/** @param {Element | null} word the name of an attribute, or its value @returns {string} the attribute's name */
function attributeAt(word) {
  if (word?.matches("i.name")) return word.textContent ?? "";
  const name = word?.matches("i.value") ? word.previousElementSibling : null;
  return name?.matches("i.name") ? (name.textContent ?? "") : "";
}

/** Asks again after every good run, but not at every step of a drag. @param {{value: string}} text */
function useFresh(text) {
  const run = built.value;
  const there = connection.value === "connected" && robot.value !== null;
  useEffect(() => {
    if (!there) return undefined;
    const later = setTimeout(
      async () => {
        const answer = await send({ type: "get_urdf" }).catch(() => null);
        if (answer?.type === "urdf") text.value = answer.text;
      },
      text.value ? SETTLE_MS : 0,
    );
    return () => clearTimeout(later);
  }, [run, there]);
}

const PARTS = /(<!--.*?(?:-->|$))|(<\/?[\w:.-]+|\/?>|\?>|<\?xml)|([\w:.-]+)(=)("[^"]*")/g;

/** @param {string} line of XML @returns {unknown[]} its parts with their colours */
function coloured(line) {
  /** @type {unknown[]} */
  const parts = [];
  let at = 0;
  for (const match of line.matchAll(PARTS)) {
    const [whole, comment, tag, name, equals, value] = match;
    parts.push(line.slice(at, match.index));
    if (comment) parts.push(html`<i class="comment">${comment}</i>`);
    else if (tag) parts.push(html`<b>${tag}</b>`);
    else parts.push(html`<i class="name">${name}</i>`, equals, html`<i class="value">${value}</i>`);
    at = match.index + whole.length;
  }
  return [...parts, line.slice(at), "\n"];
}

/** @param {string} text */
function download(text) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/xml" }));
  link.download = `${title.value.replace(/(\.urdf)?(\.xacro)?$/, "") || "robot"}.urdf`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
