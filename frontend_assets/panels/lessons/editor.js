/** Writing a lesson: its text on one side, how it will look and what is faulty in it on the other. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { LessonRead } from "../../types/wire.d.ts" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { drawnBlock } from "../../app/help-drawing.js";
import { t } from "../../lib/i18n.js";
import { Icon, IconButton } from "../../lib/ui.js";
import { readFaults, saveLesson } from "../../model/lesson-steps.js";
import {
  askLessons,
  chosenLesson,
  followLink,
  lessonTexts,
  readLesson,
} from "../../model/lessons.js";
import { notify } from "../../model/view.js";
import { Step } from "./steps.js";

/** So long nothing is typed before the faults are asked for. */
const REST_MS = 400;
const NAME = "[a-z0-9][a-z0-9_\\-]{0,59}";

/** @param {{name: string, onClose: () => void}} props `name` empty: a lesson that is new */
export function LessonEditor({ name, onClose }) {
  const given = name ? (lessonTexts.value.get(name)?.text ?? "") : t("lessons.edit.template");
  const [text, named] = [useSignal(given), useSignal(name)];
  const read = useSignal(/** @type {LessonRead | null} */ (null));
  useEffect(() => {
    const timer = setTimeout(async () => {
      read.value = await readFaults(text.value);
    }, REST_MS);
    return () => clearTimeout(timer);
  }, [text.value]);
  const save = async (/** @type {Event} */ event) => {
    event.preventDefault();
    if (!(await saveLesson(named.value, text.value))) return;
    notify(t("lessons.edit.saved", { name: named.value }));
    await askLessons();
    chosenLesson.value = named.value;
    onClose();
  };
  return html`<form class="operations-chosen lesson lesson-editor" onSubmit=${save}>
    <header class="lesson-head lesson-writing"><${IconButton} icon="chevronRight" class="operation-back" label=${t("operations.back")} onClick=${onClose} />
      ${name ? html`<h3>${name}</h3>` : html`<label class="lesson-name"><span>${t("lessons.edit.name")}</span><input class="box" required pattern=${NAME} title=${t("lessons.edit.name.hint")} value=${named.value} onInput=${input(named)} /></label>`}
      <span class="push"></span><button type="button" class="button small" onClick=${onClose}>${t("cancel")}</button>
      <button type="submit" class="button small primary"><${Icon} name="disk" size=${13} />${t("command.save")}</button></header>
    <div class="lesson-editing"><label class="lesson-source"><span>${t("lessons.edit.text")}</span>
      <textarea class="box mono" spellcheck="false" maxlength="60000" value=${text.value} onInput=${input(text)}></textarea></label>
      <section class="scroll lesson-preview" tabindex="0" aria-label=${t("lessons.edit.preview")}><${Faults} read=${read.value} /><${Preview} text=${text.value} read=${read.value} /></section></div></form>`;
}

/** @param {Signal<string>} kept @returns {(event: any) => void} */
const input = (kept) => (event) => {
  kept.value = event.currentTarget.value;
};

/** @param {{read: LessonRead | null}} props */
function Faults({ read }) {
  return html`<ul class="lesson-faults" role="status">${read?.faults.map(
    ({ line, sentence }) =>
      html`<li key=${`${line} ${sentence}`}><${Icon} name="alert" size=${14} /><span>${t("lessons.edit.fault", { line, sentence })}</span></li>`,
  )}</ul>`;
}

/** @param {{text: string, read: LessonRead | null}} props */
function Preview({ text, read }) {
  const { title, blocks } = readLesson(text);
  return html`<article class="help-article lesson-text">${title && html`<h2>${title}</h2>`}${blocks.map(
    (block) =>
      block.kind === "checks"
        ? html`<${Step} lines=${block.lines} view=${read?.steps[block.step]} />`
        : drawnBlock(block, followLink),
  )}</article>`;
}
