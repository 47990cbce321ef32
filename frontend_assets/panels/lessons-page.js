/** One lesson: its demo and those that it needs, what it says, and what they print. */

/** @import { CodeFile, LessonView } from "../types/wire.d.ts" */

import { html, useEffect, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { drawnBlock } from "../app/help-drawing.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { IconButton } from "../lib/ui.js";
import {
  chosenLesson,
  demoCode,
  demos,
  fetchCode,
  followLink,
  lessonTexts,
  output,
  showOutput,
} from "../model/lessons.js";
import { notify } from "../model/view.js";
import { LessonRuns } from "./lessons-runs.js";

/** So far from its end a list still counts as scrolled to it. */
const END_PX = 4;

/** @param {{lesson: LessonView, all: readonly LessonView[]}} props */
export function LessonPage({ lesson, all }) {
  const { demo } = lesson;
  const text = lessonTexts.value.get(demo);
  const needed = (text?.needs ?? []).flatMap((name) => all.find((one) => one.demo === name) ?? []);
  const parts = [...needed, lesson];
  const close = () => {
    chosenLesson.value = "";
  };
  return html`<div class="deeds-chosen lesson">
    <header class="deed-head lesson-head"><${IconButton} icon="chevronRight" class="deed-back" label=${t("deeds.back")} onClick=${close} />
      <h3>${text?.title || demo}</h3><span class="offer-type">${`studio demos ${demo}`}</span></header>
    <div class="scroll lesson-scroll" tabindex="0" role="region" aria-label=${text?.title || demo}>
      <${LessonRuns} parts=${parts} />
      ${text?.blocks.length === 0 && html`<p class="note padded">${t("lessons.lost")}</p>`}
      <article class="help-article lesson-text">${text?.blocks.map((block) => drawnBlock(block, followLink))}</article>
      ${parts.map((part) => html`<${Code} key=${part.demo} demo=${part.demo} />`)}
    </div>
    <${Output} own=${demo} parts=${parts} />
  </div>`;
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
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  const follows = useRef(true);
  const { lines } = output.value;
  useLayoutEffect(() => {
    if (follows.current) list.current?.scrollTo({ top: list.current.scrollHeight });
  }, [lines]);
  const started = parts.map(({ demo }) => demo).filter((demo) => demos.value.has(demo));
  const shown = [chosen.value, own].find((demo) => started.includes(demo)) ?? started[0] ?? "";
  useEffect(() => {
    showOutput(shown);
    return () => showOutput("");
  }, [shown]);
  if (started.length === 0) return null;
  const onScroll = () => {
    const { scrollHeight = 0, scrollTop = 0, clientHeight = 0 } = list.current ?? {};
    follows.current = scrollHeight - scrollTop - clientHeight <= END_PX;
  };
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
