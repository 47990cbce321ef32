/** Files that another program changed: told when merged, put to a choice where both changed one place. */

/** @import { CollisionView, Collisions } from "../types/wire.d.ts" */

import { effect, html, useEffect, useId, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { markedTexts } from "../lib/text-differences.js";
import { Dialog, Icon, ProgressBar } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { diskMerged, problems } from "../model/document.js";
import { ask } from "../model/requests.js";
import { dialog, notify } from "../model/view.js";

/** @typedef {"mine" | "theirs"} Side */

/** Say when a file was merged with what is unsaved here. */
export function followDisk() {
  effect(() => {
    const merged = diskMerged.value;
    if (!merged) return;
    // Outside of the effect, which must not come to follow the notices that it makes.
    queueMicrotask(() =>
      notify(t("disk.merged", { file: baseName(merged.file), count: merged.kept })),
    );
  });
}

/** @param {string} file @param {Side} keep */
const resolve = (file, keep) => ask({ type: "resolve_collisions", file, keep });

/** A bar for each file that waits for a choice. */
export function DiskBars() {
  const waiting = problems.value.filter(({ code }) => code === "changed-on-disk");
  return waiting.map(({ place }) => {
    const file = place?.file ?? "";
    return html`<div key=${file} class="bar disk" role="alert"><${Icon} name="alert" />
      <span>${t("disk.collides", { file: baseName(file) })}</span>
      ${mayEdit.value && html`<${Choices} file=${file} />`}</div>`;
  });
}

/** @param {{file: string}} props */
function Choices({ file }) {
  const show = () => {
    dialog.value = { kind: "merge", file };
  };
  return html`<button type="button" class="button small" onClick=${() => resolve(file, "mine")}>${t("disk.mine")}</button>
    <button type="button" class="button small" onClick=${() => resolve(file, "theirs")}>${t("disk.theirs")}</button>
    <button type="button" class="button small" onClick=${show}>${t("disk.compare")}</button>`;
}

/** @param {{file: string, onClose: () => void}} props a choice for each place, or one for all */
export function MergeDialog({ file, onClose }) {
  const found = useSignal(/** @type {Collisions | null} */ (null));
  const sides = useSignal(/** @type {readonly Side[]} */ ([]));
  const load = async () => {
    const answer = await ask({ type: "get_collisions", file });
    if (answer?.type !== "collisions") return onClose();
    found.value = answer;
    sides.value = answer.places.map(() => "mine");
  };
  useEffect(() => void load(), []);
  const { places = [], count = 0, state = "" } = found.value ?? {};
  /** @param {number} at @param {Side} side */
  const choose = (at, side) => {
    sides.value = sides.value.map((one, place) => (place === at ? side : one));
  };
  /** @param {Side} side */
  const all = (side) => {
    sides.value = places.map(() => side);
  };
  const use = async () => {
    const keep = sides.value.every((side) => side === "theirs") ? "theirs" : "mine";
    if (await ask({ type: "resolve_collisions", file, keep, each: [...sides.value], state }))
      onClose();
    else await load();
  };
  return html`<${Dialog} title=${t("disk.title", { file: baseName(file) })} closeLabel=${t("close")} class="merge" onClose=${onClose}>
    <p class="dialog-text">${t("disk.text", { count })}</p>
    <div class="merge-places">
      ${
        found.value
          ? places.map(
              (
                one,
                at,
              ) => html`<${Place} key=${`${at} ${one.line}`} one=${one} chosen=${sides.value[at] ?? "mine"}
            onChoose=${(/** @type {Side} */ side) => choose(at, side)} />`,
            )
          : html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`
      }
      ${count > places.length && html`<p class="note">${t("disk.more", { count: count - places.length })}</p>`}
    </div>
    <footer><button type="button" class="button small" disabled=${!found.value} onClick=${() => all("mine")}>${t("disk.all.mine")}</button>
      <button type="button" class="button small" disabled=${!found.value} onClick=${() => all("theirs")}>${t("disk.all.theirs")}</button>
      <span class="push"></span><button type="button" class="button" onClick=${onClose}>${t("cancel")}</button>
      <button type="button" class="button primary" data-first disabled=${!found.value} onClick=${use}>${t("disk.do")}</button></footer>
  <//>`;
}

/** @param {{one: CollisionView, chosen: Side, onChoose: (side: Side) => void}} props the two sides beside each other, what both began with above */
function Place({ one, chosen, onChoose }) {
  return html`<div class="merge-place" role="radiogroup" aria-label=${t("disk.at", { line: one.line })}>
    <h3>${t("disk.line", { line: one.line })}</h3>
    <pre class="merge-base" aria-label=${t("disk.before")}>${one.base}</pre>
    <div class="merge-sides">
      <${SideOf} side="mine" text=${one.mine} other=${one.theirs} chosen=${chosen === "mine"} onChoose=${onChoose} />
      <${SideOf} side="theirs" text=${one.theirs} other=${one.mine} chosen=${chosen === "theirs"} onChoose=${onChoose} />
    </div>
  </div>`;
}

/** @param {{side: Side, text: string, other: string, chosen: boolean, onChoose: (side: Side) => void}} props what the other side has not is marked */
function SideOf({ side, text, other, chosen, onChoose }) {
  const name = useId();
  const { now } = markedTexts(other, text);
  return html`<label class=${`merge-side ${side} ${chosen ? "chosen" : ""}`}>
    <span><input type="radio" name=${name} checked=${chosen} onChange=${() => onChoose(side)} />${t(`disk.side.${side}`)}</span>
    <pre>${text ? now.map((piece) => (piece.marked ? html`<mark>${piece.text}</mark>` : piece.text)) : t("disk.nothing")}</pre></label>`;
}
