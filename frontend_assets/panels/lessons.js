/** Lessons: every demo with one page about it, to be started and stopped beside what is read. */

/** @import { LessonView } from "../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { Refusal } from "../app/refusal.js";
import { language, t } from "../lib/i18n.js";
import { EmptyState, Icon, ProgressBar, SearchBox } from "../lib/ui.js";
import { useLooking } from "../model/asking.js";
import { mayEdit } from "../model/connection.js";
import {
  askLessons,
  chosenLesson,
  demos,
  elsewhere,
  fetchLessons,
  followLessons,
  isSought,
  isUnderWay,
  lessons,
  lessonsRefused,
  lessonTexts,
  stopAllDemos,
  underWay,
} from "../model/lessons.js";
import { LessonPage } from "./lessons-page.js";

export function LessonsPanel() {
  const { panel } = useLooking(followLessons);
  const all = lessons.value;
  useEffect(() => {
    if (all)
      void fetchLessons(
        language.value,
        all.map(({ demo }) => demo),
      );
  }, [all, language.value]);
  return html`<section ref=${panel} class="panel-body deeds lessons" aria-label=${t("panel.lessons")}>
    ${lessonsRefused.value && html`<${Refusal} sentence=${lessonsRefused.value} again=${askLessons} />`}
    ${!all && !lessonsRefused.value && html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`}
    ${all && html`<${Parts} all=${all} />`}
  </section>`;
}

/** @param {{all: readonly LessonView[]}} props the list, and beside or in place of it a page */
function Parts({ all }) {
  const read = all.find(({ demo }) => demo === chosenLesson.value);
  const parts = useRef(/** @type {HTMLElement | null} */ (null));
  const before = useRef(read);
  useEffect(() => {
    const last = before.current;
    before.current = read;
    // Where the page takes the place of the list, what had the focus is hidden: it goes on with what came.
    if (last === read || (document.activeElement ?? document.body) !== document.body) return;
    const next = read ? ".lesson-scroll" : `[data-demo="${last?.demo}"]`;
    /** @type {HTMLElement | null | undefined} */ (parts.current?.querySelector(next))?.focus();
  }, [read]);
  return html`<div ref=${parts} class=${`deeds-parts ${read ? "chosen" : ""}`}>
    <${List} all=${all} />${read && html`<${LessonPage} key=${read.demo} lesson=${read} all=${all} />`}
  </div>`;
}

/** @param {{all: readonly LessonView[]}} props */
function List({ all }) {
  const words = useSignal("");
  const shown = all.filter((one) =>
    isSought(words.value, one, lessonTexts.value.get(one.demo)?.text ?? ""),
  );
  const chapters = [...new Set(shown.map(({ chapter }) => chapter))];
  return html`<div class="deeds-list">
    <div class="panel-bar"><${SearchBox} label=${t("lessons.search")} value=${words.value} onInput=${(
      /** @type {string} */ text,
    ) => {
      words.value = text;
    }} /></div>
    <${RunningNow} />
    ${shown.length === 0 && html`<${EmptyState} icon="lessons" title=${t("filter.nothing", { words: words.value })} />`}
    <nav class="scroll lessons-list" aria-label=${t("panel.lessons")}>${chapters.map(
      (chapter) => html`<section key=${chapter}><h3>${t(`lessons.chapter.${chapter}`)}</h3>
        <ul class="offers">${shown.filter((one) => one.chapter === chapter).map(({ demo }) => html`<${Row} key=${demo} demo=${demo} />`)}</ul></section>`,
    )}</nav>
  </div>`;
}

/** How many run, and the end of them. */
function RunningNow() {
  const count = underWay.value.length;
  if (count === 0) return null;
  return html`<div class="lessons-now" role="status"><span class="lessons-dot"></span><span>${t("lessons.now", { count })}</span>
    ${mayEdit.value && html`<button type="button" class="button small" onClick=${stopAllDemos}><${Icon} name="stop" size=${12} />${t("lessons.stop_all")}</button>`}</div>`;
}

/** @param {{demo: string}} props */
function Row({ demo }) {
  const runs = isUnderWay(demo) || elsewhere.value.includes(demo);
  const choose = () => {
    chosenLesson.value = demo;
  };
  return html`<li><button type="button" class="offer" data-demo=${demo} aria-pressed=${chosenLesson.value === demo} onClick=${choose}>
    <span class="lessons-title">${lessonTexts.value.get(demo)?.title || demo}</span>
    ${runs && html`<span class=${`lessons-dot ${demos.value.get(demo)?.state ?? ""}`} role="img" aria-label=${t("lessons.runs")} title=${t("lessons.runs")}></span>`}
    <span class="offer-type">${demo}</span></button></li>`;
}
