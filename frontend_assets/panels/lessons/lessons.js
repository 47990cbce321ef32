/** Lessons: every demo with one page about it, to be started and stopped beside what is read. */

/** @import { CodeFile, DemoView, LessonView, PressKey } from "../../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { drawnBlock } from "../../app/help-drawing.js";
import { copyText } from "../../lib/clipboard.js";
import { language, t } from "../../lib/i18n.js";
import { secondsSince, shortTime, useNow } from "../../lib/times.js";
import {
  EmptyState,
  Icon,
  IconButton,
  ProgressBar,
  SearchBox,
  useBusy,
  useEnd,
} from "../../lib/ui.js";
import { useLooking } from "../../model/asking.js";
import { mayAct, mayManage } from "../../model/connection.js";
import { deleteLesson, readOn, steps } from "../../model/lesson-steps.js";
import {
  askLessons,
  chosenLesson,
  demoCode,
  demos,
  demosToldAt_ms,
  elsewhere,
  fetchCode,
  fetchLessons,
  followLessons,
  followLink,
  isSought,
  isUnderWay,
  lessons,
  lessonsRefused,
  lessonTexts,
  output,
  pressKey,
  showOutput,
  startDemos,
  stopAllDemos,
  stopDemo,
  underWay,
} from "../../model/lessons.js";
import { connectRos, ros } from "../../model/ros.js";
import { dialog, notify } from "../../model/view.js";
import { isWireAway, Refusal } from "../parts.js";
import { LessonEditor } from "./editor.js";
import { Progress, Step } from "./steps.js";

export function LessonsPanel() {
  const { panel } = useLooking(followLessons);
  const all = lessons.value;
  useEffect(() => {
    if (all) void fetchLessons(language.value, all);
  }, [all, language.value]);
  return html`<section ref=${panel} class="panel-body operations lessons" aria-label=${t("panel.lessons")}>
    ${lessonsRefused.value && html`<${Refusal} sentence=${lessonsRefused.value} again=${askLessons} />`}
    ${!all && !lessonsRefused.value && html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`}
    ${all && html`<${Parts} all=${all} />`}
  </section>`;
}

/** @param {{all: readonly LessonView[]}} props the list, and beside or in place of it a page */
function Parts({ all }) {
  const edited = useSignal(/** @type {string | null} */ (null));
  const read = all.find(({ name }) => name === chosenLesson.value);
  const parts = useRef(/** @type {HTMLElement | null} */ (null));
  const before = useRef(read);
  useEffect(() => {
    const last = before.current;
    before.current = read;
    // Where the page takes the place of the list, what had the focus is hidden: it goes on with what came.
    if (last === read || (document.activeElement ?? document.body) !== document.body) return;
    const next = read ? ".lesson-scroll" : `[data-demo="${last?.name}"]`;
    /** @type {HTMLElement | null | undefined} */ (parts.current?.querySelector(next))?.focus();
  }, [read]);
  const edit = (/** @type {string | null} */ name) => {
    edited.value = name;
  };
  const isEditing = edited.value !== null && mayManage.value;
  return html`<div ref=${parts} class=${`operations-parts ${read || isEditing ? "chosen" : ""}`}>
    <${List} all=${all} onNew=${() => edit("")} />
    ${isEditing ? html`<${LessonEditor} key=${edited.value} name=${edited.value} onClose=${() => edit(null)} />` : read && html`<${LessonPage} key=${read.name} lesson=${read} all=${all} onEdit=${() => edit(read.name)} />`}
  </div>`;
}

/** @param {{all: readonly LessonView[], onNew: () => void}} props */
function List({ all, onNew }) {
  const words = useSignal("");
  const shown = all.filter((one) =>
    isSought(words.value, one, lessonTexts.value.get(one.name)?.text ?? ""),
  );
  const chapters = [...new Set(shown.map(({ chapter }) => chapter))];
  return html`<div class="operations-list">
    <div class="panel-bar"><${SearchBox} label=${t("lessons.search")} value=${words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      words.value = text;
    }} />${mayManage.value && html`<${IconButton} icon="filePlus" label=${t("lessons.new")} onClick=${onNew} />`}</div>
    <${RunningNow} />
    ${shown.length === 0 && html`<${EmptyState} icon="lessons" title=${t("filter.nothing", { words: words.value })} />`}
    <nav class="scroll lessons-list" aria-label=${t("panel.lessons")}>${chapters.map(
      (chapter) => html`<section key=${chapter}><h3>${t(`lessons.chapter.${chapter}`)}</h3>
        <ul class="offers">${shown.filter((one) => one.chapter === chapter).map((lesson) => html`<${Row} key=${lesson.name} lesson=${lesson} />`)}</ul></section>`,
    )}</nav>
  </div>`;
}

/** How many run, and the end of them. */
function RunningNow() {
  const count = underWay.value.length;
  if (count === 0) return null;
  return html`<div class="lessons-now" role="status"><span class="state-dot running"></span><span>${t("lessons.now", { count })}</span>
    ${mayManage.value && html`<button type="button" class="button small" onClick=${stopAllDemos}><${Icon} name="stop" size=${12} />${t("lessons.stop_all")}</button>`}</div>`;
}

/** @param {{lesson: LessonView}} props */
function Row({ lesson: { name, node, done, steps: count } }) {
  const runs = node !== "" && (isUnderWay(name) || elsewhere.value.includes(name));
  const choose = () => {
    chosenLesson.value = name;
  };
  return html`<li><button type="button" class="offer" data-demo=${name} aria-pressed=${chosenLesson.value === name} onClick=${choose}>
    <span class="lessons-title">${lessonTexts.value.get(name)?.title || name}</span>
    ${runs && html`<span class=${`state-dot ${demos.value.get(name)?.state ?? ""}`} role="img" aria-label=${t("lessons.runs")} title=${t("lessons.runs")}></span>`}
    ${done > 0 && html`<span class=${`lessons-done ${done === count ? "all" : ""}`} title=${t("lessons.progress", { done, count })}>${done === count ? html`<${Icon} name="check" size=${13} />` : `${done}/${count}`}</span>`}
    <span class="offer-type">${name}</span></button></li>`;
}

/**
 * One lesson: its demo and those that it needs, what it says, and what they print.
 *
 * @param {{lesson: LessonView, all: readonly LessonView[], onEdit: () => void}} props
 */
function LessonPage({ lesson, all, onEdit }) {
  const { name } = lesson;
  const text = lessonTexts.value.get(name);
  const wanted = [...(text?.needs ?? []), name];
  const parts = wanted.flatMap(
    (one) => all.find((other) => other.name === one && other.node) ?? [],
  );
  useEffect(readOn, [name]);
  const close = () => {
    chosenLesson.value = "";
  };
  return html`<div class="operations-chosen lesson">
    <header class="operation-head lesson-head"><${IconButton} icon="chevronRight" class="operation-back" label=${t("operations.back")} onClick=${close} />
      <h3>${text?.title || name}</h3>${lesson.node && html`<span class="offer-type">${`studio demos ${name}`}</span>`}
      ${lesson.writable && mayManage.value && html`<span class="lesson-tools"><${IconButton} icon="pencil" label=${t("lessons.edit")} disabled=${!text} onClick=${onEdit} /><${IconButton} icon="trash" label=${t("lessons.delete")} onClick=${() => askToDelete(name)} /></span>`}</header>
    <div class="scroll lesson-scroll" tabindex="0" role="region" aria-label=${text?.title || name}>
      <${Progress} />
      ${parts.length > 0 && html`<${LessonRuns} parts=${parts} />`}
      ${text?.blocks.length === 0 && html`<p class="note padded">${t("lessons.lost")}</p>`}
      <article class="help-article lesson-text">${text?.blocks.map((block) =>
        block.kind === "checks"
          ? html`<${Step} lines=${block.lines} view=${steps.value[block.step]} />`
          : drawnBlock(block, followLink),
      )}</article>
      ${parts.map((part) => html`<${Code} key=${part.name} demo=${part.name} />`)}
    </div>
    <${Output} own=${name} parts=${parts} />
  </div>`;
}

/** @param {string} name */
function askToDelete(name) {
  dialog.value = {
    kind: "confirm",
    title: t("lessons.delete.title", { name }),
    text: t("lessons.delete.text"),
    action: t("lessons.delete"),
    danger: true,
    run: () => void deleteLesson(name),
  };
}

/** The source code of a demo, asked for when it is unfolded. @param {{demo: string}} props */
function Code({ demo }) {
  const onToggle = (/** @type {any} */ event) => {
    if (event.currentTarget.open) void fetchCode(demo);
  };
  return html`<details class="lesson-code" onToggle=${onToggle}>
    <summary>${t("lessons.code", { demo })}</summary>
    ${demoCode.value.get(demo)?.map((file) => html`<${CodeOfFile} key=${file.name} file=${file} />`)}
  </details>`;
}

/** @param {{file: CodeFile}} props */
function CodeOfFile({ file: { name, text } }) {
  const copy = async () => {
    if (await copyText(text)) notify(t("lessons.code.copied", { file: name }));
  };
  return html`<section class="lesson-file" aria-label=${name}>
    <header><code>${name}</code><${IconButton} icon="copy" size=${14} label=${t("lessons.code.copy", { file: name })} onClick=${copy} /></header>
    <pre class="scroll" tabindex="0" role="region" aria-label=${t("lessons.code.of", { file: name })}>${text}</pre></section>`;
}

/** What one of them printed: that of the lesson itself, until another is chosen. @param {{own: string, parts: readonly LessonView[]}} props */
function Output({ own, parts }) {
  const chosen = useSignal("");
  const { lines } = output.value;
  const { list, onScroll } = useEnd([lines]);
  const started = parts.map(({ name }) => name).filter((name) => demos.value.has(name));
  const shown = [chosen.value, own].find((demo) => started.includes(demo)) ?? started[0] ?? "";
  useEffect(() => {
    showOutput(shown);
    return () => showOutput("");
  }, [shown]);
  if (started.length === 0) return null;
  return html`<section class="lesson-output" aria-label=${t("lessons.output")}>
    <header><h4>${t("lessons.output")}</h4>
      ${
        started.length > 1 &&
        started.map(
          (demo) =>
            html`<button key=${demo} type="button" class="text-button" aria-pressed=${shown === demo} onClick=${() => {
              chosen.value = demo;
            }}>${demo}</button>`,
        )
      }</header>
    <pre ref=${list} class="scroll" tabindex="0" role="log" aria-live="off" onScroll=${onScroll}>${lines.join("\n") || t("lessons.output.none")}</pre>
  </section>`;
}

/**
 * The demos of a lesson: how each fares, its start and stop, and its keys.
 *
 * @param {{parts: readonly LessonView[]}} props in the order in which they are started
 */
function LessonRuns({ parts }) {
  const waiting = parts.map(({ name }) => name).filter((name) => !isThere(name));
  const canStart = mayManage.value && !isWireAway();
  return html`<section class="lesson-runs" aria-label=${t("lessons.demos")}>
    ${isWireAway() && html`<${Connect} />`}
    <ul>${parts.map((one) => html`<${Run} key=${one.name} lesson=${one} />`)}</ul>
    ${canStart && parts.length > 1 && waiting.length > 1 && html`<${StartAll} waiting=${waiting} />`}
    ${!mayManage.value && html`<p class="note">${t("lessons.viewer")}</p>`}
  </section>`;
}

/** @param {string} demo */
const isThere = (demo) => isUnderWay(demo) || elsewhere.value.includes(demo);

/** What is missing for a start, and the click that mends it. */
function Connect() {
  const busy = useSignal(false);
  const connect = async () => {
    busy.value = true;
    await connectRos();
    busy.value = false;
  };
  const isOnTheWay = busy.value || ros.value.state === "connecting";
  return html`<p class="lesson-connect"><span>${t("ros.first")}</span>
    ${
      mayManage.value &&
      html`<button type="button" class="button primary small" disabled=${isOnTheWay} onClick=${connect}>
      ${isOnTheWay ? html`<span class="spinner"></span>` : html`<${Icon} name="link" size=${13} />`}${t("ros.connect")}</button>`
    }</p>`;
}

/** @param {{waiting: readonly string[]}} props */
function StartAll({ waiting }) {
  return html`<button type="button" class="button" onClick=${() => startDemos(waiting)}>
    <${Icon} name="animate" size=${13} />${t("lessons.start_all", { count: waiting.length })}</button>`;
}

/** @param {{lesson: LessonView}} props */
function Run({ lesson }) {
  const { name: demo, node, has_keys: hasKeys } = lesson;
  const view = demos.value.get(demo);
  const isStranger = elsewhere.value.includes(demo) && !isUnderWay(demo);
  return html`<li class="lesson-run"><div class="lesson-run-line">
      <div class="lesson-run-names"><strong>${demo}</strong><span class="muted" title=${node}>${node}</span></div>
      ${!isStranger && html`<${Buttons} demo=${demo} />`}</div>
    ${isStranger ? html`<p class="note">${t("lessons.elsewhere", { node })}</p>` : html`<${State} view=${view} />`}
    ${hasKeys && mayAct.value && view?.state === "running" && html`<${Keys} demo=${demo} />`}</li>`;
}

/** @param {{demo: string}} props */
function Buttons({ demo }) {
  const { busy, during } = useBusy();
  if (!mayManage.value) return null;
  if (isUnderWay(demo))
    return html`<button type="button" class="button small" disabled=${busy} aria-label=${t("lessons.stop.of", { demo })} onClick=${during(() => stopDemo(demo))}>
      <${Icon} name="stop" size=${12} />${t("lessons.stop")}</button>`;
  return html`<button type="button" class="button small primary" disabled=${busy || isWireAway()} aria-label=${t("lessons.start.of", { demo })} onClick=${during(() => startDemos([demo]))}>
    <${Icon} name="animate" size=${12} />${t("lessons.start")}</button>`;
}

/** @param {{view: DemoView | undefined}} props how it fares; nothing, of one that was never started */
function State({ view }) {
  const since_s = secondsSince(demosToldAt_ms.value, useNow());
  if (!view) return null;
  const isBusy = view.state === "starting" || view.state === "stopping";
  const isBad = view.state === "ended" && view.code !== 0;
  return html`<p class=${`lesson-state ${isBad ? "bad" : ""}`} role="status">
    ${isBusy ? html`<span class="spinner"></span>` : html`<span class=${`state-dot ${view.state}`}></span>`}<span>${stateWords(view, since_s)}</span></p>`;
}

/** @param {DemoView} view @param {number} since_s it was told @returns {string} */
function stateWords({ state, for_s, code, reason }, since_s) {
  if (state !== "ended") return t(`lessons.state.${state}`, { time: shortTime(for_s + since_s) });
  if (code === 0) return t("lessons.state.ended");
  if (code < 0) return t("lessons.state.killed", { signal: -code });
  return t("lessons.state.failed", { code, reason });
}

/** @type {readonly {pressed: PressKey["pressed"], key: string, face: string}[]} */
const KEYS = [
  { pressed: "up", key: "ArrowUp", face: "↑" },
  { pressed: "down", key: "ArrowDown", face: "↓" },
  { pressed: "left", key: "ArrowLeft", face: "←" },
  { pressed: "right", key: "ArrowRight", face: "→" },
  .../** @type {const} */ (["g", "t", "r", "e", "d", "c", "v", "b", "f"]).map((pressed) => ({
    pressed,
    key: pressed,
    face: pressed.toUpperCase(),
  })),
];

/** The keys that drive it: by clicks, and by themselves while one of these has the focus. @param {{demo: string}} props */
function Keys({ demo }) {
  const onKeyDown = (/** @type {KeyboardEvent} */ event) => {
    const found = KEYS.find(({ key }) => key === event.key || key === event.key.toLowerCase());
    if (!found || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    void pressKey(demo, found.pressed);
  };
  return html`<div class="lesson-keys" role="group" aria-label=${t("lessons.keys", { demo })} title=${t("lessons.keys.hint")} onKeyDown=${onKeyDown}>${KEYS.map(
    ({ pressed, face }) =>
      html`<button key=${pressed} type="button" class="button small" aria-label=${pressed} onClick=${() => pressKey(demo, pressed)}>${face}</button>`,
  )}</div>`;
}
