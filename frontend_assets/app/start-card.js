/**
 * Robots to begin with: the ones that were opened last, the examples, and the card with both that
 * stands where no robot is open.
 */

/** @import { ExampleEntry, RecentEntry } from "../types/wire.d.ts" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { language, t } from "../lib/i18n.js";
import { timeAgo } from "../lib/times.js";
import { EmptyState, Icon, IconButton, moveFocus, ProgressBar } from "../lib/ui.js";
import { connection, documentId, role } from "../model/connection.js";
import { ask, openNamed } from "../model/requests.js";
import { dialog, theme } from "../model/view.js";
import { FileButtons } from "./uploads.js";

export function StartCard() {
  if (documentId.value !== "" || connection.value !== "connected") return null;
  if (role.value !== "presenter") {
    return html`<div class="start-layer"><section class="start-card" aria-label=${t("start.title")}>
      <p class="open-text">${t("start.viewer")}</p></section></div>`;
  }
  return html`<div class="start-layer"><section class="start-card" aria-labelledby="start-title">
    <h1 id="start-title">${t("start.title")}</h1>
    <div class="start-buttons">
      <${StartButton} tab="browse" icon="open" label="command.open" primary=${true} />
      <${StartButton} tab="new" icon="filePlus" label="command.new_robot" primary=${false} />
      <${StartButton} tab="paste" icon="clipboard" label="command.new_pasted" primary=${false} />
      <${StartButton} tab="browse" icon="bag" label="command.open_bag" primary=${false} />
      <${ConnectButton} />
    </div>
    <${FileButtons} />
    <h2>${t("open.tab.recent")}</h2>
    <${RecentList} limit=${5} />
    <h2>${t("open.tab.examples")}</h2>
    <${ExampleCards} />
  </section></div>`;
}

/** @param {{tab: import("../model/view.js").OpenTab, icon: string, label: string, primary: boolean}} props */
function StartButton({ tab, icon, label, primary }) {
  const show = () => {
    dialog.value = { kind: "open", tab };
  };
  return html`<button type="button" class=${`button ${primary ? "primary" : ""}`} onClick=${show}>
    <${Icon} name=${icon} />${t(label)}…</button>`;
}

/** A robot that runs may be met before any is open. */
function ConnectButton() {
  const show = () => {
    dialog.value = { kind: "ros" };
  };
  return html`<button type="button" class="button" onClick=${show}><${Icon} name="link" />${t("start.connect")}…</button>`;
}

const ICONS = { file: "fileCode", example: "robot", upload: "upload", untitled: "clipboard" };

/** @param {{limit?: number}} props */
export function RecentList({ limit = 30 }) {
  const files = useSignal(/** @type {readonly RecentEntry[] | null} */ (null));
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  /** @param {import("../model/wire.js").Answer | null} answer */
  const take = (answer) => {
    if (answer?.type === "recent") files.value = answer.files;
  };
  useEffect(() => {
    ask({ type: "list_recent" }).then(take);
  }, []);
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step && moveFocus(list.current, step)) event.preventDefault();
  };
  if (!files.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  if (files.value.length === 0)
    return html`<${EmptyState} icon="history" title=${t("recent.empty")} />`;
  return html`<ul class="entries recent" ref=${list} onKeyDown=${onKeyDown}>
    ${files.value.slice(0, limit).map(
      (file) =>
        html`<${RecentRow} key=${file.path} file=${file} onForget=${async () => {
          take(await ask({ type: "forget_recent", path: file.path }));
        }} />`,
    )}
  </ul>`;
}

/** @param {{file: RecentEntry, onForget: () => void}} props */
function RecentRow({ file, onForget }) {
  const open = () => openNamed({ type: "open_recent", path: file.path });
  const when = file.is_there
    ? timeAgo(file.time_s * 1000, Date.now(), language.value)
    : t("recent.gone");
  return html`<li class=${`entry ${file.is_there ? "" : "off"}`}>
    <button type="button" class="entry-main" disabled=${!file.is_there} onClick=${open} title=${file.path}>
      <${Icon} name=${file.is_there ? ICONS[file.origin] : "alert"} />
      <span class="entry-two"><span class="entry-name">${file.title}</span><span class="entry-path"><bdi>${file.path}</bdi></span></span>
      <span class="entry-when">${when}</span>
    </button>
    <${IconButton} icon="close" size=${14} label=${t("recent.forget", { name: file.title })} onClick=${onForget} />
  </li>`;
}

/** The models that the studio ships; each opens as a copy of one's own. */
export function ExampleCards() {
  const found = useSignal(/** @type {readonly ExampleEntry[] | null} */ (null));
  useEffect(() => {
    ask({ type: "list_examples" }).then((answer) => {
      if (answer?.type === "examples") found.value = answer.examples;
    });
  }, []);
  if (!found.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  return html`<div class="example-page"><p class="open-text">${t("examples.text")}</p>
    <ul class="cards">${found.value.map((one) => html`<li key=${one.name}><${ExampleCard} example=${one} /></li>`)}</ul></div>`;
}

/** @param {{example: ExampleEntry}} props */
function ExampleCard({ example }) {
  const key = `example.${example.name}`;
  // A model that the page has no words for says itself what it shows.
  const text = t(key) === key ? example.text : t(key);
  return html`<button type="button" class="card" onClick=${() => openNamed({ type: "open_example", name: example.name })}>
    <${Picture} name=${example.robot} /><strong>${example.robot}</strong><span>${text}</span></button>`;
}

/** @param {{name: string}} props a small picture of a robot, in the page's own colours */
export function Picture({ name }) {
  const address = new URL(`../pictures/${name}-${theme.value}.webp`, import.meta.url);
  return html`<img class="card-picture" src=${address.href} alt="" width="240" height="150" loading="lazy" />`;
}
