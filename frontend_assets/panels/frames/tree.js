/** The frames of TF as a tree: who tells of each, how often, how long ago, and which branch is broken. */

/** @import { FrameRow } from "../../lib/frame-tree.js" */
/** @import { FrameView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { frameRows, framesAbove, isOwn } from "../../lib/frame-tree.js";
import { t } from "../../lib/i18n.js";
import { LongList, siblingPlaces } from "../../lib/long-list.js";
import { reveal } from "../../lib/seen.js";
import { shortTime } from "../../lib/times.js";
import { Icon, IconButton, LongName } from "../../lib/ui.js";
import { robot } from "../../model/document.js";
import { hovered } from "../../model/selection.js";
import {
  chain,
  fixedFrame,
  reference,
  setReference,
  setTarget,
  target,
  tfFrames,
} from "../../model/tf.js";
import { viewport } from "../../model/viewport.js";

/** @param {{filter: string}} props */
export function FramesTree({ filter }) {
  const folded = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  const active = useSignal("");
  useEffect(() => showTarget(folded), [target.value]);
  const rows = frameRows(tfFrames.value, fixedFrame.value, folded.value, filter);
  if (rows.length === 0)
    return html`<p class="nothing">${t("filter.nothing", { words: filter })}</p>`;
  const places = siblingPlaces(rows.map(({ level }) => level));
  const focusable = [active.value, target.value, rows[0]?.frame.name].find((name) =>
    rows.some(({ frame }) => frame.name === name),
  );
  /** @param {string} name @param {boolean} open */
  const setOpen = (name, open) => {
    const now = new Set(folded.value);
    if (open) now.delete(name);
    else now.add(name);
    folded.value = now;
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const at = rows.findIndex(({ frame }) => frame.name === focusable);
    const to = moved(event, rows, at, setOpen);
    if (to === null) return;
    event.preventDefault();
    const name = rows[Math.min(Math.max(to, 0), rows.length - 1)]?.frame.name ?? "";
    active.value = name;
    requestAnimationFrame(() => document.getElementById(rowId(name))?.focus());
  };
  return html`<div class="tree tf-tree" role="tree" aria-label=${t("tf.frames")} onKeyDown=${onKeyDown}
    onPointerLeave=${() => {
      hovered.value = null;
    }}>
    <${LongList} items=${rows} keyOf=${nameOf} row="var(--row)"
      isKept=${(/** @type {FrameRow} */ row) => [focusable, target.value].includes(nameOf(row))}
      draw=${(/** @type {FrameRow} */ row, /** @type {number} */ at) =>
        html`<${Row} key=${nameOf(row)} row=${row} place=${places[at]} focusable=${nameOf(row) === focusable} setOpen=${setOpen}
        onFocus=${() => {
          active.value = nameOf(row);
        }} />`} />
  </div>`;
}

/** What is chosen elsewhere comes into view. @param {Signal<ReadonlySet<string>>} folded @returns {() => void} the end of it */
function showTarget(folded) {
  const name = target.peek();
  if (name === null) return () => {};
  const above = new Set(framesAbove(tfFrames.peek(), name));
  if ([...folded.peek()].some((one) => above.has(one)))
    folded.value = new Set([...folded.peek()].filter((one) => !above.has(one)));
  let end = () => {};
  const frame = requestAnimationFrame(() => {
    end = reveal(document.getElementById(rowId(name)));
  });
  return () => {
    cancelAnimationFrame(frame);
    end();
  };
}

/** @param {FrameRow} row */
const nameOf = ({ frame }) => frame.name;

/** @param {string} name */
const rowId = (name) => `tf-frame-${name}`;

/**
 * @param {KeyboardEvent} event @param {readonly FrameRow[]} rows @param {number} at
 * @param {(name: string, open: boolean) => void} setOpen
 * @returns {number | null} the row to go to; null: the key is none of a tree's
 */
function moved({ key, shiftKey, ctrlKey, metaKey }, rows, at, setOpen) {
  const row = rows[at];
  if (!row || ctrlKey || metaKey) return null;
  const name = nameOf(row);
  const fold = (/** @type {boolean} */ open) => {
    setOpen(name, open);
    return at;
  };
  /** @type {Record<string, () => number>} */
  const keys = {
    ArrowDown: () => at + 1,
    ArrowUp: () => at - 1,
    Home: () => 0,
    End: () => rows.length - 1,
    ArrowRight: () => (row.expandable && !row.expanded ? fold(true) : at + 1),
    ArrowLeft: () => (row.expanded ? fold(false) : parentAt(rows, at)),
    Enter: () => {
      (shiftKey ? setReference : setTarget)(name);
      return at;
    },
  };
  return keys[key]?.() ?? null;
}

/** @param {readonly FrameRow[]} rows @param {number} at @returns {number} */
function parentAt(rows, at) {
  const above = rows.findLastIndex((row, n) => n < at && row.level < (rows[at]?.level ?? 1));
  return Math.max(above, 0);
}

/**
 * @param {{row: FrameRow, place: {at: number, of: number} | undefined, focusable: boolean,
 *   setOpen: (name: string, open: boolean) => void, onFocus: () => void}} props
 */
function Row({ row, place, focusable, setOpen, onFocus }) {
  const { frame, level, expandable, expanded } = row;
  const { name } = frame;
  const isLink = robot.value?.links.some((link) => link.name === name);
  return html`<div id=${rowId(name)} role="treeitem" class=${rowClass(row)} style=${`--level:${level}`} tabindex=${focusable ? 0 : -1}
    aria-level=${level} aria-posinset=${place?.at} aria-setsize=${place?.of} aria-expanded=${expandable ? expanded : null}
    aria-selected=${target.value === name} aria-label=${rowLabel(row)} title=${[name, ...wordsOf(row)].join("\n")} onFocus=${onFocus} onClick=${() => setTarget(name)}
    onDblClick=${() => isLink && viewport.value?.focus(name)}
    onPointerEnter=${() => {
      hovered.value = isLink ? name : null;
    }}>
    <span class="twisty" aria-hidden="true" onClick=${(/** @type {MouseEvent} */ event) => {
      event.stopPropagation();
      if (expandable) setOpen(name, !expanded);
    }}>${expandable && html`<${Icon} name=${expanded ? "chevronDown" : "chevronRight"} size=${14} />`}</span>
    <${Icon} name=${isLink ? "box" : "frames"} size=${14} />
    <span class="tree-label"><${LongName} text=${name} /></span>${" "}
    <${State} row=${row} />${" "}
    <${Reference} name=${name} isTarget=${target.value === name} />${" "}
    <span class="tf-publisher">${publisherOf(frame)}</span>${" "}
    <span class="tf-rate numbers">${rateOf(frame)}</span>${" "}
    <span class="tf-age numbers">${ageOf(frame)}</span>
  </div>`;
}

/** @param {FrameRow} row @returns {string} */
function rowClass(row) {
  const { name } = row.frame;
  const states = [
    target.value === name && "chosen",
    hovered.value === name && "hovered",
    target.value !== null && chain.value.has(name) && "on-chain",
    shownState(row),
  ];
  return ["tree-row", "tf-row", ...states].filter(Boolean).join(" ");
}

/** @param {FrameRow} row @returns {string} what its row shows, in that order, and what else is known of the frame */
function rowLabel(row) {
  const { frame } = row;
  const kind = shownState(row);
  const shown = [
    frame.name,
    kind === "fresh" ? "" : t(`tf.${kind}`),
    reference.value === frame.name ? t("frames.in") : "",
    publisherOf(frame),
    rateOf(frame),
    agoOf(frame),
  ];
  return [...new Set([...shown, ...wordsOf(row)])].filter(Boolean).join(", ");
}

/** @param {FrameRow} row */
const shownState = ({ frame, behind }) =>
  frame.state === "fresh" && behind ? "behind" : frame.state;

/** @param {FrameRow} row @returns {string[]} all that is known of a frame */
function wordsOf({ frame, behind }) {
  const words = frame.parent ? [t("tf.in", { parent: frame.parent }), publisherOf(frame)] : [];
  const rest = frame.parent ? [rateOf(frame), agoOf(frame)] : [t("tf.root")];
  const state =
    frame.state === "fresh" ? "" : t(`tf.${frame.state}.text`, { fixed: fixedFrame.value });
  const above = behind ? t("tf.behind.text", { frame: behind }) : "";
  return [...words, ...rest, state, above].filter(Boolean);
}

/** @param {{row: FrameRow}} props a word, for colour alone tells nobody */
function State({ row }) {
  const kind = shownState(row);
  if (kind === "fresh") return null;
  return html`<span class=${`tf-state ${kind}`}>${kind !== "behind" && html`<${Icon} name="alert" size=${12} />`}<span>${t(`tf.${kind}`)}</span></span>`;
}

/** @param {{name: string, isTarget: boolean}} props the mark of the frame in which poses are told, and the way to have it so */
function Reference({ name, isTarget }) {
  if (reference.value === name)
    return html`<span class="tf-reference" title=${t("frames.reference")}>${t("frames.in")}</span>`;
  if (!isTarget) return null;
  const take = (/** @type {Event} */ event) => {
    event.stopPropagation();
    setReference(name);
  };
  return html`<${IconButton} icon="compare" label=${t("tf.take_reference", { frame: name })} class="tf-take" size=${14} onClick=${take} />`;
}

/** @param {FrameView} frame @returns {string} */
function publisherOf(frame) {
  if (frame.parent === "") return "";
  return isOwn(frame) ? t("tf.own") : frame.publisher;
}

/** @param {FrameView} frame @returns {string} how often it comes, or why it comes once */
function rateOf(frame) {
  if (frame.parent === "") return t("tf.root");
  if (isOwn(frame)) return isFixed(frame.name) ? t("tf.static") : t("tf.joint");
  if (frame.static) return t("tf.static");
  return frame.rate_hz > 0 ? `${frame.rate_hz.toFixed(frame.rate_hz < 10 ? 1 : 0)} Hz` : "–";
}

/** @param {string} link @returns {boolean} its joint cannot move */
const isFixed = (link) => robot.value?.joints.find(({ child }) => child === link)?.type === "fixed";

/** @param {FrameView} frame */
const ageOf = ({ age_s: age }) => (age === null ? "" : shortTime(age));

/** @param {FrameView} frame */
const agoOf = ({ age_s: age }) => (age === null ? "" : t("tf.ago", { time: shortTime(age) }));
