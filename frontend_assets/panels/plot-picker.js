/** Which number is drawn, by hand: a topic, and a path into its messages. */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { numberPaths } from "../lib/number-paths.js";
import { typeOf } from "../model/interfaces.js";
import { addSeries } from "../model/plotting.js";
import { followTopics, topics } from "../model/topics.js";
import { stepsOf } from "../workers/message-paths.js";

/** @param {{onDone: () => void}} props */
export function PlotPicker({ onDone }) {
  const topic = useSignal("");
  const path = useSignal("");
  const paths = useSignal(/** @type {readonly string[]} */ ([]));
  useEffect(followTopics, []);
  const type = topics.value?.find(({ name }) => name === topic.value)?.types[0] ?? "";
  useEffect(() => {
    let closed = false;
    paths.value = [];
    if (type)
      typeOf(type).then(({ messages }) => {
        if (!closed && messages) paths.value = numberPaths(messages, type);
      });
    return () => {
      closed = true;
    };
  }, [type]);
  const steps = stepsOf(path.value);
  const isWrong = path.value !== "" && steps === null;
  const canAdd = topic.value.startsWith("/") && steps !== null && steps.length > 0;
  const add = (/** @type {Event} */ event) => {
    event.preventDefault();
    if (!canAdd) return;
    addSeries(topic.value.trim(), path.value.trim());
    path.value = "";
    onDone();
  };
  return html`<form class="plot-picker" onSubmit=${add}>
    <input list="plot-topics" class="box" aria-label=${t("topics.name")} placeholder=${t("plot.topic")} value=${topic.value} spellcheck=${false} autocomplete="off"
      onInput=${(/** @type {any} */ event) => {
        topic.value = event.currentTarget.value;
      }} />
    <datalist id="plot-topics">${topics.value?.map(({ name }) => html`<option key=${name} value=${name}></option>`)}</datalist>
    <input list="plot-paths" class="box" aria-label=${t("plot.path")} placeholder=${t("plot.path")} value=${path.value} spellcheck=${false} autocomplete="off" aria-invalid=${isWrong}
      onInput=${(/** @type {any} */ event) => {
        path.value = event.currentTarget.value;
      }} />
    <datalist id="plot-paths">${paths.value.map((one) => html`<option key=${one} value=${one}></option>`)}</datalist>
    <button type="submit" class="button primary" disabled=${!canAdd}>${t("plot.draw")}</button>
    ${isWrong && html`<p class="note">${t("plot.wrong_path")}</p>`}
  </form>`;
}
