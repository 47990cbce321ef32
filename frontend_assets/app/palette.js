/** The palette: every command, panel, link, joint, property, file and problem by its name. */

/** @import { Rank, Ranked, Span } from "../lib/ranking.js" */
/** @import { Choice } from "./palette-choices.js" */

import { html, useEffect, useMemo, useRef, useSignal } from "vendor/preact.js";
import { oneLine } from "../lib/course-lines.js";
import { t } from "../lib/i18n.js";
import { marksOf, ranked } from "../lib/ranking.js";
import { recall, remember } from "../lib/remembered.js";
import { Dialog, Icon } from "../lib/ui.js";
import { mayManage } from "../model/connection.js";
import {
  allChoices,
  askExamples,
  commandChoices,
  examples,
  fileChoices,
  lineChoices,
} from "./palette-choices.js";

const RECENT = "palette.recent";
const RECENT_MOST = 5;
/** Of each kind, where several kinds are shown and where only one is. */
const EACH_MOST = 7;
const ONE_MOST = 60;
/** Characters. */
const PASTED_MAX = 4000;

/** @param {{onClose: () => void}} props */
export function Palette({ onClose }) {
  const typed = useSignal("");
  const at = useSignal(0);
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  // Lessons, demos and lines of ROS 2 come with the palette, not with the page.
  const ros = useSignal(/** @type {typeof import("./palette-ros.js") | null} */ (null));
  useEffect(() => {
    void import("./palette-ros.js").then((part) => {
      ros.value = part;
      return part.askForLessons();
    });
    if (mayManage.value) void askExamples();
  }, []);
  const known = useMemo(allChoices, [examples.value]);
  const all = [
    ...known,
    ...(ros.value?.lessonChoices() ?? []),
    ...(ros.value?.demoChoices() ?? []),
  ];
  const search = readSearch(typed.value);
  const lines = ros.value?.ros2Choices(typed.value) ?? [];
  const sections = [...sectionsOf(lines, ONE_MOST), ...found(all, typed.value)];
  const choices = sections.flatMap((section) => section.choices);
  const active = Math.min(at.value, choices.length - 1);
  useEffect(() => {
    list.current?.querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
  }, [active, typed.value]);
  /** @param {Choice | undefined} choice */
  const run = (choice) => {
    if (!choice) return;
    keepRecent(choice.key);
    onClose();
    // The window is gone by then, so that what was found may take the focus.
    setTimeout(choice.run);
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const to = movedTo(event.key, active, choices.length);
    if (to !== null) at.value = to;
    else if (event.key === "Enter") run(choices[active]);
    else return;
    event.preventDefault();
  };
  /** @param {any} event */
  const onInput = (event) => {
    typed.value = event.currentTarget.value;
    at.value = 0;
  };
  /** @param {any} event lines of a terminal: the box itself would take them for one word */
  const onPaste = (event) => {
    const pasted = event.clipboardData?.getData("text/plain") ?? "";
    if (!pasted.trim().includes("\n")) return;
    event.preventDefault();
    typed.value = oneLine(pasted).slice(0, PASTED_MAX);
    at.value = 0;
  };
  return html`<${Dialog} title=${t("command.palette")} closeLabel=${t("close")} class="palette" onClose=${onClose}>
    <input type="text" class="palette-input" role="combobox" aria-expanded="true" aria-controls="palette-list" data-first
      aria-activedescendant=${choices[active] ? `palette-${active}` : null} aria-label=${t("palette.hint")} placeholder=${t("palette.hint")}
      value=${typed.value} spellcheck=${false} autocomplete="off" onKeyDown=${onKeyDown} onInput=${onInput} onPaste=${onPaste} />
    <div class="palette-list" id="palette-list" role="listbox" aria-label=${t("command.palette")} ref=${list}>
      ${sections.map((section) => {
        const from = choices.indexOf(/** @type {Choice} */ (section.choices[0]));
        return html`<${Part} key=${section.heading} section=${section} from=${from} active=${active} words=${search.words} onRun=${run} onPoint=${(
          /** @type {number} */ n,
        ) => {
          at.value = n;
        }} />`;
      })}
      ${choices.length === 0 && html`<p class="nothing">${t("filter.nothing", { words: typed.value })}</p>`}
    </div>
    <${Foot} choice=${choices[active]} />
  <//>`;
}

/** @param {string} key @param {number} at @param {number} count @returns {number | null} null: the key moves nothing */
function movedTo(key, at, count) {
  const last = Math.max(count - 1, 0);
  switch (key) {
    case "ArrowDown":
      return at >= last ? 0 : at + 1;
    case "ArrowUp":
      return at <= 0 ? last : at - 1;
    case "PageDown":
      return Math.min(at + EACH_MOST, last);
    case "PageUp":
      return Math.max(at - EACH_MOST, 0);
    default:
      return null;
  }
}

/**
 * @param {{section: Section<Choice>, from: number, active: number, words: string,
 *   onRun: (choice: Choice) => void, onPoint: (n: number) => void}} props `from`: number of its first one
 */
function Part({ section, from, active, words, onRun, onPoint }) {
  const heading = t(`palette.kind.${section.heading}`);
  return html`<div role="group" aria-label=${heading}>
    <div class="palette-heading" aria-hidden="true">${heading}</div>
    ${section.choices.map(
      (
        choice,
        n,
      ) => html`<div key=${choice.key} id=${`palette-${from + n}`} role="option" class="palette-item"
      aria-selected=${from + n === active} onClick=${() => onRun(choice)} onPointerMove=${() => onPoint(from + n)}>
      <${Icon} name=${choice.icon} /><span class="palette-label"><${Marked} text=${choice.label} words=${words} /></span>
      ${choice.hint && html`<kbd>${choice.hint}</kbd>`}</div>`,
    )}
    ${section.more > 0 && html`<div class="palette-more">${t("palette.more", { count: section.more })}</div>`}
  </div>`;
}

/** @param {{text: string, words: string}} props with the letters that were found marked */
function Marked({ text, words }) {
  let end = 0;
  const parts = marksOf(text, words).flatMap((/** @type {Span} */ [from, to]) => {
    const part = [text.slice(end, from), html`<mark>${text.slice(from, to)}</mark>`];
    end = to;
    return part;
  });
  return html`${parts}${text.slice(end)}`;
}

/** @param {{choice: Choice | undefined}} props what Enter does now, and the signs that ask for one kind */
function Foot({ choice }) {
  return html`<footer class="palette-foot">
    <span class="palette-does">${choice && html`<kbd>Enter</kbd> ${choice.does}`}</span>
    <span class="palette-signs">${Object.keys(SIGNS).map(
      (sign) =>
        html`<span key=${sign}><kbd>${sign}</kbd> ${t(`palette.sign.${nameOfSign(sign)}`)}</span>`,
    )}</span>
  </footer>`;
}

/** @param {string} sign @returns {string} the first kind that it asks for */
const nameOfSign = (sign) => SIGNS[sign]?.[0] ?? "";

/** @param {readonly Choice[]} all @param {string} text @returns {Section<Choice>[]} */
function found(all, text) {
  if (text.trim() === "") return atFirst(all);
  const search = readSearch(text);
  if (search.line > 0) {
    const places = atLine(search);
    if (places.length > 0) return sectionsOf(places, ONE_MOST);
  }
  const whole = search.line > 0 ? { ...search, words: text.trim() } : search;
  const fit = fitting(all, whole);
  const kinds = new Set(fit.map(({ rank }) => rank));
  return sectionsOf(fit, kinds.size > 1 ? EACH_MOST : ONE_MOST);
}

/** @param {Search} search with a line @returns {Choice[]} */
function atLine({ words, line, column }) {
  if (words === "") return lineChoices(line, column);
  return fitting(fileChoices(line), { kinds: null, words, line, column });
}

/** @param {readonly Choice[]} all @returns {Section<Choice>[]} what was used last, and all that can be done */
function atFirst(all) {
  const recent = recentKeys().flatMap((key) => all.find((one) => one.key === key) ?? []);
  const commands = sectionsOf(commandChoices(), ONE_MOST);
  if (recent.length === 0) return commands;
  const others = commands.map((section) => ({
    ...section,
    choices: section.choices.filter(({ key }) => !recent.some((one) => one.key === key)),
  }));
  return [
    { heading: "recent", choices: recent, more: 0 },
    ...others.filter(({ choices }) => choices.length > 0),
  ];
}

/** @returns {string[]} newest first */
function recentKeys() {
  const stored = recall(RECENT);
  return Array.isArray(stored) ? stored.filter((key) => typeof key === "string") : [];
}

/** @param {string} key */
function keepRecent(key) {
  remember(RECENT, [key, ...recentKeys().filter((one) => one !== key)].slice(0, RECENT_MOST));
}

/** Typed first, these signs ask for some kinds only. @type {Record<string, readonly Rank[]>} */
const SIGNS = {
  ">": ["command", "panel"],
  "@": ["link", "joint"],
  "#": ["property", "literal"],
  "/": ["file"],
  "!": ["problem"],
};

/** @typedef {{kinds: readonly Rank[] | null, words: string, line: number, column: number}} Search `line`: 0 if none was asked for */

/** @param {string} text @returns {Search} */
export function readSearch(text) {
  const trimmed = text.trimStart();
  const kinds = SIGNS[trimmed[0] ?? ""] ?? null;
  const rest = kinds ? trimmed.slice(1) : trimmed;
  const place = /^(.*?):(\d{1,9})(?::(\d{1,9}))?\s*$/.exec(rest);
  const [, words = rest, line = "0", column = "1"] = place ?? [];
  return { kinds, words: words.trim(), line: Number(line), column: Number(column) };
}

/**
 * @template {Ranked} T
 * @typedef {{heading: string, choices: T[], more: number}} Section `more`: so many fit, too
 */

/**
 * @template {Ranked} T
 * @param {readonly T[]} found in order
 * @param {number} most of each kind
 * @returns {Section<T>[]} one for each kind, that of the best first
 */
export function sectionsOf(found, most) {
  /** @type {Map<string, T[]>} */
  const kinds = new Map();
  for (const one of found) {
    const those = kinds.get(one.rank);
    if (those) those.push(one);
    else kinds.set(one.rank, [one]);
  }
  return [...kinds].map(([heading, all]) => ({
    heading,
    choices: all.slice(0, most),
    more: Math.max(all.length - most, 0),
  }));
}

/**
 * @template {Ranked} T
 * @param {readonly T[]} all
 * @param {Search} search
 * @returns {T[]}
 */
export function fitting(all, { kinds, words }) {
  return ranked(kinds ? all.filter(({ rank }) => kinds.includes(rank)) : all, words);
}
