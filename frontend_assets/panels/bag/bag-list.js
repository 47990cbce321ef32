/** The bags that there are: each opened as a document of its own, or shown with the robot that is open. */

/** @import { BagEntry } from "../../types/wire.d.ts" */

import { html, useEffect } from "vendor/preact.js";
import { address } from "../../lib/address.js";
import { language, t } from "../../lib/i18n.js";
import { sizeWords } from "../../lib/timeline.js";
import { shortTime, timeAgo } from "../../lib/times.js";
import { EmptyState, Icon, IconButton, MenuButton, ProgressBar, useBusy } from "../../lib/ui.js";
import { documentId, mayEdit, mayManage } from "../../model/connection.js";
import { bagPart, bags, bagsRefused, followBags, openRecorded } from "../../model/recording.js";
import { openBag } from "../../model/time.js";
import { Refusal } from "../parts.js";

export function BagList() {
  useEffect(() => followBags(), []);
  const all = bags.value;
  if (bagsRefused.value)
    return html`<${Refusal} sentence=${bagsRefused.value} again=${() => followBags()()} />`;
  if (!all) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  return html`<div class="scroll bag-list">
    ${all.bags.length === 0 && html`<${Nothing} folder=${all.folder} />`}
    <ul class="entries">${all.bags.map((one) => html`<${BagRow} key=${one.path} one=${one} />`)}</ul>
    ${all.bags.length > 0 && html`<p class="note padded">${t("bag.folder")} <bdi class="place">${all.folder}</bdi></p>`}
  </div>`;
}

/** @param {{folder: string}} props */
function Nothing({ folder }) {
  const record = () => {
    bagPart.value = "record";
  };
  return html`<${EmptyState} icon="bag" title=${t("bag.none", { folder })}>
    <button type="button" class="button" onClick=${record}>${t("bag.part.record")}</button><//>`;
}

/** @param {BagEntry} bag @returns {import("../../lib/ui.js").MenuItem[]} its files, each to be saved */
const filesOf = ({ name, files }) =>
  files.map((file) => ({
    label: file,
    icon: "download",
    run: () => {
      const link = document.createElement("a");
      link.href = address(`/api/bags/${encodeURIComponent(name)}/${encodeURIComponent(file)}`);
      link.download = file;
      link.click();
    },
  }));

/** @param {{one: BagEntry}} props */
function BagRow({ one }) {
  const { busy, during } = useBusy();
  const { path, name, begin_s, seconds, bytes, messages: count } = one;
  const facts = [shortTime(seconds), sizeWords(bytes), t("bag.messages.count", { count })];
  if (begin_s > 0) facts.unshift(timeAgo(begin_s * 1000, Date.now(), language.value));
  const show = () => openBag(path);
  const canShow = documentId.value !== "" && mayEdit.value;
  return html`<li class="entry bag-entry">
    <button type="button" class="entry-main" disabled=${busy || !mayManage.value} onClick=${during(() => openRecorded(path))} title=${path}>
      <${Icon} name="bag" /><span class="entry-two"><span class="entry-name">${name}</span><span class="bag-entry-facts">${facts.join(" · ")}</span></span></button>
    ${mayManage.value && one.files.length > 0 && html`<${MenuButton} label=${t("bag.download", { name })} items=${() => filesOf(one)}><${Icon} name="download" /><//>`}
    ${canShow && html`<${IconButton} icon="robot" label=${t("bag.show_here", { name })} disabled=${busy} onClick=${during(show)} />`}
  </li>`;
}
