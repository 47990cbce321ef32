/**
 * The newest message of a topic as a tree: rows to unfold, paths and values to copy, numbers to
 * drag into a plot; who is at its ends, and how it is subscribed.
 */

/** @import { Misfit, TopicEnd, TopicEnds as Ends, TopicRow } from "../../types/wire.d.ts" */
/** @import { Echo } from "../../model/data-lane.js" */
/** @import { SubscriptionView } from "../../workers/subscriptions.js" */
/** @import { Newest } from "../topic-panel.js" */

import { html, useSignal } from "vendor/preact.js";
import { copyText } from "../../lib/clipboard.js";
import { DdsTag } from "../../lib/dds-tag.js";
import { t } from "../../lib/i18n.js";
import { LongList, siblingPlaces } from "../../lib/long-list.js";
import { shownNumber } from "../../lib/numbers.js";
import { Icon, IconButton } from "../../lib/ui.js";
import { askedWhenChanged, useTold } from "../../model/asking.js";
import { mayEdit } from "../../model/connection.js";
import { addDisplay } from "../../model/live-displays.js";
import { plot } from "../../model/plotting.js";
import { chosenTopic, listening, topicEnds } from "../../model/topics.js";
import { notify } from "../../model/view.js";
import { ListeningMenu } from "../listening-menu.js";
import { beginDrag, endDrag } from "../topic-drag.js";
import { useNewest } from "../topic-panel.js";

/** @param {{topic: string, row: TopicRow | undefined}} props */
export function TopicEcho({ topic, row }) {
  const paused = useSignal(false);
  const showsEnds = useSignal(false);
  const { reliable, latched } = listening.value;
  const ways = /** @type {const} */ ({ reliable, latched, pace: "at_once" });
  const newest = useNewest(topic, ways, () => !paused.value);
  const { subscription, message, lane } = newest;
  return html`<section class="topics-echo" aria-label=${t("topics.echo.of", { topic })}>
    <div class="panel-bar topics-head">
      <strong title=${topic}>${topic}</strong>
      <span class="push"></span>
      <${IconButton} icon="info" label=${t("topics.connections")} pressed=${showsEnds.value} onClick=${() => {
        showsEnds.value = !showsEnds.value;
      }} />
      <${ListeningMenu} label=${t("topics.qos")} listening=${listening} hint=${subscription ? qosWords(subscription) : undefined} />
      ${row?.kind && mayEdit.value && html`<${IconButton} icon="scene" label=${t("topics.show", { kind: row.kind })} onClick=${() => addDisplay(row.kind, topic)} />`}
      <${IconButton} icon="copy" label=${t("topics.copy_message")} disabled=${!message} onClick=${() => copyAt(lane.current, "")} />
      <${IconButton} icon=${paused.value ? "animate" : "pause"} label=${t(paused.value ? "topics.go_on" : "topics.pause")} pressed=${paused.value} onClick=${() => {
        paused.value = !paused.value;
      }} />
      <${IconButton} icon="close" label=${t("topics.echo.close")} onClick=${() => {
        chosenTopic.value = null;
      }} />
    </div>
    <${TopicEnds} topic=${topic} listed=${showsEnds.value} />
    <${Said} newest=${newest} />
    ${
      message?.value &&
      html`<${EchoTree} topic=${topic} type=${subscription?.type_name ?? ""} value=${message.value}
      onMore=${(/** @type {string} */ path, /** @type {number} */ count) => lane.current?.unfold(path, count)}
      onCopy=${(/** @type {string} */ path) => copyAt(lane.current, path)} />`
    }
    ${message?.hex && html`<pre class="topics-hex scroll" tabindex=${0}>${message.hex}</pre>`}
  </section>`;
}

/** @param {Echo | null} lane @param {string} path */
async function copyAt(lane, path) {
  const text = (await lane?.text(path)) ?? "";
  const done = await copyText(text);
  notify(done ? t("topics.copied") : t("copy.failed"), { bad: !done });
}

/** @param {SubscriptionView} subscription @returns {string} */
const qosWords = ({ reliable, latched }) =>
  [
    t(reliable ? "topics.qos.reliable" : "topics.qos.best_effort"),
    latched ? t("topics.qos.latched") : "",
  ]
    .filter(Boolean)
    .join(", ");

/** @param {{newest: Newest}} props the message, or what is in the way and what to do */
function Said({ newest: { subscription, message, why } }) {
  if (subscription === null)
    return html`<p class="topics-said muted" role="status">${t("loading")}</p>`;
  const words = [
    subscription.type_name,
    message ? t("topics.bytes", { count: message.bytes }) : "",
    message && message.lost > 0 ? t("topics.lost", { count: message.lost }) : "",
  ];
  return html`<p class="topics-said" role="status"><span class="muted">${words.filter(Boolean).join(" · ")}</span>
    ${why && html`<span class="topics-trouble"><${Icon} name="alert" size=${13} /><span>${why}</span></span>`}</p>`;
}

const MORE = 500;

/** @param {string} path */
const rowId = (path) => `echo-${path}`;

/**
 * A message as a tree: rows to unfold, paths and values to copy, numbers to drag into a plot.
 *
 * @param {{topic: string, type: string, value: any, onMore: (path: string, count: number) => void,
 * onCopy: (path: string) => void}} props
 */
function EchoTree({ topic, type, value, onMore, onCopy }) {
  const toggled = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  const active = useSignal("");
  const rows = echoRows(value, toggled.value);
  const places = siblingPlaces(rows.map(({ level }) => level));
  const current = rows.some(({ path }) => path === active.value)
    ? active.value
    : (rows[0]?.path ?? "");
  const toggle = (/** @type {string} */ path) => {
    const now = new Set(toggled.value);
    if (!now.delete(path)) now.add(path);
    toggled.value = now;
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const to = moved(
      event,
      rows,
      rows.findIndex(({ path }) => path === current),
      toggle,
    );
    if (to === null) return;
    event.preventDefault();
    active.value = rows[to]?.path ?? current;
    requestAnimationFrame(() => document.getElementById(rowId(active.value))?.focus());
  };
  if (rows.length === 0) return html`<p class="note padded">${t("topics.empty")}</p>`;
  return html`<div class="tree echo-tree" role="tree" aria-label=${t("topics.echo.of", { topic })} onKeyDown=${onKeyDown}>
    <${LongList} items=${rows} keyOf=${(/** @type {EchoRow} */ { path }) => path} row="var(--row)"
      isKept=${(/** @type {EchoRow} */ { path }) => path === current}
      draw=${(/** @type {EchoRow} */ row, /** @type {number} */ at) =>
        html`<${Row} key=${row.path} topic=${topic} type=${type} row=${row} place=${places[at]} focusable=${row.path === current}
          onToggle=${() => toggle(row.path)} onMore=${onMore} onCopy=${onCopy} onFocus=${() => {
            active.value = row.path;
          }} />`} />
  </div>`;
}

/**
 * @param {KeyboardEvent} event @param {readonly EchoRow[]} rows @param {number} at
 * @param {(path: string) => void} toggle
 * @returns {number | null} the row to go to; null: the key is none of a tree's
 */
function moved({ key, ctrlKey, metaKey }, rows, at, toggle) {
  const row = rows[at];
  if (!row || ctrlKey || metaKey) return null;
  const fold = () => {
    toggle(row.path);
    return at;
  };
  const above = rows.findLastIndex((one, n) => n < at && one.level < row.level);
  /** @type {Record<string, () => number>} */
  const keys = {
    ArrowDown: () => Math.min(at + 1, rows.length - 1),
    ArrowUp: () => Math.max(at - 1, 0),
    Home: () => 0,
    End: () => rows.length - 1,
    ArrowRight: () =>
      row.expandable && !row.expanded ? fold() : Math.min(at + 1, rows.length - 1),
    ArrowLeft: () => (row.expanded ? fold() : Math.max(above, 0)),
  };
  return keys[key]?.() ?? null;
}

/**
 * @param {{topic: string, type: string, row: EchoRow, place: {at: number, of: number} | undefined, focusable: boolean, onToggle: () => void,
 *   onMore: (path: string, count: number) => void, onCopy: (path: string) => void, onFocus: () => void}} props
 */
function Row({ topic, type, row, place, focusable, onToggle, onMore, onCopy, onFocus }) {
  const { path, name, level, text, whole, expandable, expanded, numeric, shown, more } = row;
  const moreWords = more > 0 && expanded ? t("topics.more", { count: more }) : "";
  const what = { topic, type, kind: "", path };
  const scalar = numeric && !expandable;
  return html`<div id=${rowId(path)} role="treeitem" class="tree-row echo-row" style=${`--level:${level}`} tabindex=${focusable ? 0 : -1}
    aria-level=${level} aria-posinset=${place?.at} aria-setsize=${place?.of} aria-expanded=${expandable ? expanded : null} aria-label=${[name, moreWords, text].filter(Boolean).join(" ")}
    title=${path} draggable=${numeric} onFocus=${onFocus} onClick=${() => expandable && onToggle()}
    onDragStart=${(/** @type {DragEvent} */ event) => beginDrag(event, what)} onDragEnd=${endDrag}>
    <span class="twisty" aria-hidden="true">${expandable && html`<${Icon} name=${expanded ? "chevronDown" : "chevronRight"} size=${14} />`}</span>
    <span class="echo-name">${name}</span>${" "}
    <span class=${`echo-value numbers ${scalar ? "scalar" : ""}`} title=${expanded ? null : whole}>${expanded ? "" : text}</span>
    <span class="echo-tools" onClick=${(/** @type {Event} */ event) => event.stopPropagation()}>
      ${moreWords && html`<button type="button" class="echo-more" onClick=${() => onMore(path, shown + MORE)}>${moreWords}</button>`}
      ${numeric && html`<${IconButton} icon="plot" label=${t("topics.plot", { path })} size=${14} onClick=${() => plot(topic, path)} />`}
      <${IconButton} icon="link" label=${t("topics.copy_path", { path })} size=${14} onClick=${() => copyPath(path)} />
      <${IconButton} icon="copy" label=${t("topics.copy_value", { path })} size=${14} onClick=${() => onCopy(path)} />
    </span>
  </div>`;
}

/** @param {string} path */
async function copyPath(path) {
  const done = await copyText(path);
  notify(done ? t("topics.copied_path", { path }) : t("copy.failed"), { bad: !done });
}

/**
 * Who publishes a topic and who subscribes to it, how, and what keeps them apart.
 *
 * @param {{topic: string, listed: boolean}} props what keeps them apart is said in any case
 */
export function TopicEnds({ topic, listed }) {
  const first = /** @type {Ends | null} */ (null);
  const whenChanged = (/** @type {() => Promise<void>} */ look) => askedWhenChanged(look, "graph");
  const answer = useTold(first, () => topicEnds(topic), whenChanged, [topic]).value;
  if (!answer) return listed && html`<p class="note padded">${t("loading")}</p>`;
  if (!listed && answer.misfits.length === 0) return null;
  return html`<div class="topics-ends scroll">
    ${listed && html`<${Side} title=${t("topics.publishers", { count: answer.publishers.length })} ends=${answer.publishers} />`}
    ${listed && html`<${Side} title=${t("topics.subscribers", { count: answer.subscribers.length })} ends=${answer.subscribers} />`}
    ${answer.misfits.map((one) => html`<${Apart} key=${one.publisher + one.subscriber} misfit=${one} />`)}
  </div>`;
}

/** @param {{title: string, ends: readonly TopicEnd[]}} props */
function Side({ title, ends }) {
  return html`<h3>${title}</h3><ul>${ends.map(
    (end, n) =>
      html`<li key=${n}><span>${end.node}${end.own && html` <small class="muted">${t("topics.own")}</small>`}<${DdsTag} bridge=${end.bridge} /></span><small class="muted">${qosOf(end)}</small></li>`,
  )}</ul>`;
}

/** @param {TopicEnd} end @returns {string} */
function qosOf(end) {
  const words = [
    end.reliability,
    end.durability,
    `${end.history} ${end.depth}`,
    end.deadline_s === null ? "" : t("topics.deadline", { time: end.deadline_s }),
    end.lifespan_s === null ? "" : t("topics.lifespan", { time: end.lifespan_s }),
    end.liveliness === "automatic" ? "" : end.liveliness,
    end.hash === "" && end.bridge !== "" ? t("topics.no_hash") : "",
  ];
  return words.filter(Boolean).join(" · ");
}

/** @param {{misfit: Misfit}} props what DDS does or would do, and what Zenoh and a bridge do */
function Apart({ misfit }) {
  const { publisher, subscriber, reasons, heard, way } = misfit;
  const never = way === "none" ? "none" : way === "dds" ? "on_dds" : "all";
  const key = heard ? (way === "bridge" ? "bridge" : "dds") : never;
  return html`<p class="topics-apart"><${Icon} name="alert" size=${13} /><span>${t(
    `topics.apart.${key}`,
    { publisher, subscriber, reasons: reasons.join("; ") },
  )}</span></p>`;
}

/** @typedef {{"@list": number, items: any[]}} LongListCut */
/** @typedef {{"@text": number, begin: string}} LongTextCut */

/**
 * @typedef {object} EchoRow
 * @property {string} path as `.pose.position.x`; empty: the message itself
 * @property {string} name
 * @property {number} level from 1
 * @property {string} text its value, or in short what is below it
 * @property {string} whole the same with all digits
 * @property {boolean} expandable
 * @property {boolean} expanded
 * @property {boolean} numeric it can be drawn over time
 * @property {number} shown items of its list that are here; 0: it is none
 * @property {number} more those that are not
 */

/** Lists of so many numbers are said in one row. */
const INLINE_MOST = 6;

/** @param {any} value @returns {value is LongListCut} */
const isCutList = (value) => typeof value === "object" && value !== null && "@list" in value;
/** @param {any} value @returns {value is LongTextCut} */
const isCutText = (value) => typeof value === "object" && value !== null && "@text" in value;

/**
 * @param {any} message as the worker folded it
 * @param {ReadonlySet<string>} toggled paths that are not as they are at first: short things are open, lists are not
 * @returns {EchoRow[]}
 */
export function echoRows(message, toggled) {
  /** @type {EchoRow[]} */
  const rows = [];
  addChildren(rows, message, "", 1, toggled);
  return rows;
}

/** @param {EchoRow[]} rows @param {any} value @param {string} path @param {number} level @param {ReadonlySet<string>} toggled */
function addChildren(rows, value, path, level, toggled) {
  const items = isCutList(value) ? value.items : value;
  const isItems = Array.isArray(items);
  for (const [name, child] of Object.entries(items)) {
    const at = isItems ? `${path}[${name}]` : `${path}.${name}`;
    const row = rowOf(child, at, isItems ? `[${name}]` : name, level, toggled);
    rows.push(row);
    if (row.expanded) addChildren(rows, child, at, level + 1, toggled);
  }
}

/** @param {any} value @param {string} path @param {string} name @param {number} level @param {ReadonlySet<string>} toggled @returns {EchoRow} */
function rowOf(value, path, name, level, toggled) {
  const isList = Array.isArray(value) || isCutList(value);
  const holds = typeof value === "object" && value !== null && !isCutText(value);
  const expandable = holds && countOf(value) > 0;
  const openAtFirst = !isList && !isTime(value);
  return {
    path,
    name,
    level,
    text: echoText(value),
    whole: echoText(value, String),
    expandable,
    expanded: expandable && toggled.has(path) !== openAtFirst,
    numeric: isNumeric(value) || isTime(value),
    shown: isList ? countOf(value) : 0,
    more: isCutList(value) ? value["@list"] - value.items.length : 0,
  };
}

/** @param {any} value @returns {number} */
function countOf(value) {
  if (isCutList(value)) return value.items.length;
  return Array.isArray(value) ? value.length : Object.keys(value).length;
}

/** @param {any} value */
const isNumeric = (value) => ["number", "bigint", "boolean"].includes(typeof value);

/** @param {any} value a time or a span of ROS */
const isTime = (value) =>
  typeof value === "object" && value !== null && "sec" in value && "nanosec" in value;

/** @param {any} value @param {(value: number) => string} [write] @returns {string} in one line */
function echoText(value, write = numberText) {
  if (typeof value === "number") return write(value);
  if (typeof value === "string") return value;
  if (typeof value !== "object" || value === null) return String(value);
  if (isCutText(value)) return `${value.begin}…`;
  if (isTime(value)) return `${value.sec}.${String(value.nanosec).padStart(9, "0")}`;
  if (isCutList(value)) return listText(value.items, value["@list"], write);
  return Array.isArray(value) ? listText(value, value.length, write) : objectText(value, write);
}

/** @param {number} value @returns {string} whole numbers have all their digits */
const numberText = (value) => (Number.isInteger(value) ? String(value) : shownNumber(value));

/** @param {readonly any[]} items @param {number} count @param {(value: number) => string} write @returns {string} */
function listText(items, count, write) {
  if (count === 0) return "[]";
  const plain = items.slice(0, INLINE_MOST).every((one) => typeof one !== "object");
  if (!plain) return `[${count}]`;
  const shown = items
    .slice(0, INLINE_MOST)
    .map((one) => echoText(one, write))
    .join(", ");
  return count > INLINE_MOST ? `[${count}] ${shown}, …` : `[${shown}]`;
}

/** @param {object} value @param {(value: number) => string} write @returns {string} vectors and poses are said whole */
function objectText(value, write) {
  const parts = Object.entries(value);
  if (parts.length === 0) return "{}";
  if (parts.length > 4 || !parts.every(([, one]) => isNumeric(one))) return "";
  return parts.map(([name, one]) => `${name} ${echoText(one, write)}`).join("  ");
}
