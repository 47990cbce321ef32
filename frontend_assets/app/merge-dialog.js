/** Files that another program changed: told when merged, put to a choice where both changed one place. */

/** @import { Collisions, CollisionView } from "../types/wire.d.ts" */

import { effect, html, useEffect, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { baseName } from "../lib/paths.js";
import { Dialog, Icon, ProgressBar } from "../lib/ui.js";
import { ask } from "./actions.js";
import { mayEdit } from "./state/connection.js";
import { diskMerged, problems } from "./state/document.js";
import { dialog, notify } from "./state/view.js";

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
      ${mayEdit.value && html`<${Choices} file=${file} compare />`}</div>`;
  });
}

/** @param {{file: string, compare?: boolean, onDone?: () => void}} props */
function Choices({ file, compare = false, onDone = () => {} }) {
  /** @param {Side} keep */
  const choose = async (keep) => {
    if (await resolve(file, keep)) onDone();
  };
  const show = () => {
    dialog.value = { kind: "merge", file };
  };
  return html`<button type="button" class="button small" onClick=${() => choose("mine")}>${t("disk.mine")}</button>
    <button type="button" class="button small" onClick=${() => choose("theirs")}>${t("disk.theirs")}</button>
    ${compare && html`<button type="button" class="button small" onClick=${show}>${t("disk.compare")}</button>`}`;
}

/** @param {{file: string, onClose: () => void}} props */
export function MergeDialog({ file, onClose }) {
  const found = useSignal(/** @type {Collisions | null} */ (null));
  const load = async () => {
    const answer = await ask({ type: "get_collisions", file });
    if (answer?.type === "collisions") found.value = answer;
    else onClose();
  };
  useEffect(() => void load(), []);
  const { places = [], count = 0 } = found.value ?? {};
  return html`<${Dialog} title=${t("disk.title", { file: baseName(file) })} closeLabel=${t("close")} class="merge" onClose=${onClose}>
    <p class="dialog-text">${t("disk.text", { count })}</p>
    <div class="merge-places">
      ${found.value ? places.map((one) => html`<${Place} key=${one.line} one=${one} />`) : html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`}
      ${count > places.length && html`<p class="note">${t("disk.more", { count: count - places.length })}</p>`}
    </div>
    <footer><span class="push"></span><${Choices} file=${file} onDone=${onClose} /></footer>
  <//>`;
}

/** @param {{one: CollisionView}} props the two sides beside each other, what both began with above */
function Place({ one }) {
  return html`<section class="merge-place" aria-label=${t("disk.line", { line: one.line })}>
    <h3>${t("disk.line", { line: one.line })}</h3>
    <pre class="merge-base" aria-label=${t("disk.before")}>${one.base}</pre>
    <div class="merge-sides">
      <figure class="mine"><figcaption>${t("disk.side.mine")}</figcaption><pre>${one.mine || t("disk.nothing")}</pre></figure>
      <figure class="theirs"><figcaption>${t("disk.side.theirs")}</figcaption><pre>${one.theirs || t("disk.nothing")}</pre></figure>
    </div>
  </section>`;
}
