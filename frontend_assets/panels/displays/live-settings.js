/** Settings of a live display as rows of the tree: its topic, how it listens, and its properties. */

/** @import { DisplayKindView, DisplayView, PropertyView } from "../../types/wire.d.ts" */
/** @import { Row } from "./tree.js" */
/** @import { Listening } from "../../model/live-displays.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { asText } from "../../lib/frame-pose.js";
import { t } from "../../lib/i18n.js";
import { counts, settingRows } from "../../lib/live-displays.js";
import { niceStep, parseNumber, shownNumber } from "../../lib/numbers.js";
import { PickBox } from "../../lib/pick-box.js";
import { TextBox } from "../../lib/slider.js";
import { Switch } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { robot } from "../../model/document.js";
import {
  fixedFrame,
  framesNow,
  kinds,
  listenTo,
  poseNow,
  setProperty,
  settingOf,
  topicsNow,
} from "../../model/live-displays.js";

const POSE_EVERY_MS = 1000;

/** @param {DisplayView} display @param {number} level @param {(id: string) => boolean} isOpen @returns {Row[]} */
export function settingsOf(display, level, isOpen) {
  const kind = kinds.value.get(display.kind);
  if (!kind) return [{ id: `setting:${display.id}`, level, label: t("loading"), icon: "" }];
  const properties = [...kind.properties, ...display.more];
  const byName = new Map(properties.map((one) => [one.name, one]));
  const counting = properties.filter((one) =>
    counts(one, byName, (name) => settingOf(display, name)),
  );
  const idOf = (/** @type {string} */ path) => `setting:${display.id}:${path}`;
  const rows = settingRows(counting, (path) => isOpen(idOf(path)));
  return [
    ...(kind.types.length > 0 ? listeningRows(display, kind, level, isOpen) : []),
    ...rows.flatMap(({ path, label, depth, folds, property }) => [
      {
        id: idOf(path),
        level: level + depth,
        label,
        icon: "",
        hint: property?.doc ?? label,
        expandable: folds,
        expanded: folds && isOpen(idOf(path)),
        kind: "setting",
        ...(property && {
          controls: () => html`<${Editor} key=${path} display=${display} property=${property} />`,
        }),
      },
      ...(folds && isOpen(idOf(path)) ? poseRows(display, path, level + depth + 1, idOf) : []),
    ]),
  ];
}

const OF_LINK = /^Links\/(?!All Links Enabled$)(.+)$/;

/** Where a link of a robot is, as RViz tells it below the link. @param {DisplayView} display @param {string} path @param {number} level @param {(path: string) => string} idOf @returns {Row[]} */
function poseRows(display, path, level, idOf) {
  const link = display.kind === "RobotModel" ? OF_LINK.exec(path)?.[1] : undefined;
  if (!link) return [];
  const prefix = String(settingOf(display, "TF Prefix") ?? "").replace(/^\/+|\/+$/g, "");
  const frame = prefix ? `${prefix}/${link}` : link;
  return [
    {
      id: idOf(`${path}/pose`),
      level,
      label: t("live.pose"),
      icon: "",
      kind: "setting",
      hint: t("live.pose.hint", { frame }),
      controls: () => html`<${Pose} key=${frame} frame=${frame} />`,
    },
  ];
}

/** @param {{frame: string}} props asked for as long as it is seen */
function Pose({ frame }) {
  const words = useSignal("");
  const fixed = fixedFrame.value || (robot.value?.root ?? "");
  useEffect(() => {
    let isThere = true;
    const ask = async () => {
      const { pose, trouble } = await poseNow(frame, fixed);
      if (isThere) words.value = pose ? `${asText(pose.xyz)} · ${asText(pose.wxyz)}` : trouble;
    };
    ask();
    const timer = setInterval(() => document.hidden || ask(), POSE_EVERY_MS);
    return () => {
      isThere = false;
      clearInterval(timer);
    };
  }, [frame, fixed]);
  return html`<output class="fact" aria-label=${t("live.pose.hint", { frame })} title=${words.value}>${words.value}</output>`;
}

/** @param {DisplayView} display @param {DisplayKindView} kind @param {number} level @param {(id: string) => boolean} isOpen @returns {Row[]} */
function listeningRows(display, kind, level, isOpen) {
  const { id, topic, wished } = display;
  const row = `setting:${id}:listening`;
  const open = isOpen(row);
  const listen = (/** @type {Partial<Listening>} */ news) =>
    void listenTo(id, { topic, ...wished, ...news });
  return [
    {
      id: `setting:${id}:topic`,
      level,
      label: t("live.topic"),
      icon: "",
      kind: "setting",
      hint: kind.types.join("\n"),
      controls:
        () => html`<${PickBox} label=${t("live.topic")} text=${topic} placeholder=${t("live.topic.none")}
        disabled=${!mayEdit.value} choices=${() => topicsFor(kind)} none=${t("live.topic.nothing", { type: kind.types[0] ?? "" })}
        onWrite=${(/** @type {string} */ typed) => listen({ topic: typed })} />`,
    },
    {
      id: row,
      level,
      label: t("live.listening"),
      icon: "",
      kind: "setting",
      expandable: true,
      expanded: open,
      meta: open ? "" : listeningWords(display),
    },
    ...(open ? qosRows(display, level + 1, listen) : []),
  ];
}

/** @param {{types: readonly string[]}} kind @returns {Promise<string[]>} topics that it shows */
async function topicsFor({ types }) {
  const topics = (await topicsNow()) ?? [];
  return topics.filter((one) => one.types.some((type) => types.includes(type))).map(nameOf);
}

/** @param {{name: string}} named */
const nameOf = ({ name }) => name;

/** @param {DisplayView} display @returns {string} */
function listeningWords({ wished, reliable, latched, depth }) {
  const { reliable: r, latched: l, depth: d } = wished;
  if (r === null && l === null && d === null) return t("live.as_publishers");
  const words = [t(reliable ? "live.reliable" : "live.best_effort"), latched && t("live.latched")];
  return [...words.filter(Boolean), String(depth)].join(", ");
}

/** @param {DisplayView} display @param {number} level @param {(news: Partial<Listening>) => void} listen @returns {Row[]} */
function qosRows({ id, wished, reliable, latched, depth }, level, listen) {
  /** @param {string} name @param {() => import("vendor/preact.js").ComponentChildren} controls @returns {Row} */
  const row = (name, controls) => ({
    id: `setting:${id}:${name}`,
    level,
    label: t(`live.qos.${name}`),
    icon: "",
    kind: "setting",
    controls,
  });
  /** @param {"reliable" | "latched"} name @param {boolean} now @param {string} yes @param {string} no */
  const either = (name, now, yes, no) =>
    html`<${Choice} label=${t(`live.qos.${name}`)} value=${String(wished[name])}
      choices=${[
        ["null", t("live.qos.auto", { now: now ? yes : no })],
        ["true", yes],
        ["false", no],
      ]} onChoose=${(/** @type {string} */ chosen) => listen({ [name]: JSON.parse(chosen) })} />`;
  return [
    row("reliable", () => either("reliable", reliable, t("live.reliable"), t("live.best_effort"))),
    row("latched", () => either("latched", latched, t("live.yes"), t("live.no"))),
    row(
      "depth",
      () => html`<${TextBox} class="number narrow" label=${t("live.qos.depth")} text=${String(depth)}
      number=${depth} step=${1} disabled=${!mayEdit.value} onWrite=${(
        /** @type {string} */ typed,
      ) => {
        const number = Math.round(parseNumber(typed) ?? 0);
        listen({ depth: number >= 1 ? Math.min(number, 10_000) : null });
      }} />`,
    ),
  ];
}

/** @param {{label: string, value: string, choices: readonly (readonly [string, string])[], onChoose: (value: string) => void}} props */
function Choice({ label, value, choices, onChoose }) {
  return html`<select class="box" aria-label=${label} value=${value} disabled=${!mayEdit.value}
    onChange=${(/** @type {any} */ event) => onChoose(event.currentTarget.value)}>
    ${choices.map(([one, words]) => html`<option key=${one} value=${one} selected=${one === value}>${words}</option>`)}
  </select>`;
}

/** @param {{display: DisplayView, property: PropertyView}} props the widget of a property */
function Editor({ display, property }) {
  const value = settingOf(display, property.name) ?? property.default;
  const set = (/** @type {boolean | number | string} */ one) =>
    void setProperty(display.id, property.name, one);
  const label = `${display.name}: ${property.name}`;
  const off = !mayEdit.value;
  switch (property.kind) {
    case "switch":
      return html`<${Switch} label=${label} checked=${value === true} disabled=${off} onChange=${set} />`;
    case "colour":
      return html`<input type="color" class="colour" aria-label=${label} title=${String(value)} value=${String(value)} disabled=${off}
        onInput=${(/** @type {any} */ event) => set(event.currentTarget.value)} />`;
    case "choice":
      return html`<${Choice} label=${label} value=${String(value)} choices=${property.choices.map((one) => [one, one])} onChoose=${set} />`;
    case "frame":
      return html`<${PickBox} label=${label} text=${String(value)} disabled=${off} onWrite=${set} none=${t("live.frame.none")}
        choices=${async () => ["<Fixed Frame>", ...(await framesNow()).map(nameOf)]} />`;
    case "topic":
      return html`<${PickBox} label=${label} text=${String(value)} disabled=${off} onWrite=${set} placeholder=${t("live.topic.none")}
        none=${t("live.topic.nothing", { type: property.choices[0] ?? "" })} choices=${() => topicsFor({ types: property.choices })} />`;
    case "fact":
      return html`<output class="fact" aria-label=${label} title=${String(value)}>${String(value)}</output>`;
    case "text":
      return html`<${PickBox} label=${label} text=${String(value)} disabled=${off} onWrite=${set} placeholder=""
        choices=${property.choices.length > 0 ? async () => property.choices : undefined} />`;
    default:
      return html`<${NumberEditor} label=${label} property=${property} value=${Number(value)} set=${set} />`;
  }
}

/** @param {{label: string, property: PropertyView, value: number, set: (value: number) => void}} props */
function NumberEditor({ label, property, value, set }) {
  const { low, high, unit, kind } = property;
  if (low === 0 && high === 1 && kind === "number")
    return html`<input type="range" class="slider short" min="0" max="1" step="0.01" value=${value} aria-label=${label}
      title=${shownNumber(value)} disabled=${!mayEdit.value} style=${`--fill:${value * 100}%`}
      onInput=${(/** @type {any} */ event) => set(Number(event.currentTarget.value))} />`;
  const step = kind === "whole" ? 1 : niceStep(0, Math.max(Math.abs(value), 0.01) * 4);
  /** @param {string} typed */
  const write = (typed) => {
    const number = parseNumber(typed);
    if (number === null) return;
    const within = Math.min(Math.max(number, low ?? number), high ?? number);
    set(kind === "whole" ? Math.round(within) : within);
  };
  return html`<${TextBox} class="number narrow" label=${label} text=${shownNumber(value)} number=${value} step=${step}
    disabled=${!mayEdit.value} onWrite=${write} />${unit && html`<span class="unit">${unit}</span>`}`;
}
