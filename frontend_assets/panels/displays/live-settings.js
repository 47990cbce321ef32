/** Settings of a live display as rows of the tree: its topic, how it listens, and its properties. */

/** @import { DisplayKindView, DisplayView, PropertyView } from "../../types/wire.d.ts" */
/** @import { Row } from "./tree.js" */
/** @import { Listening } from "../../model/live-displays.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { asText } from "../../lib/frame-pose.js";
import { t } from "../../lib/i18n.js";
import { counts, settingRows } from "../../lib/live-displays.js";
import { parseNumber } from "../../lib/numbers.js";
import { PickBox } from "../../lib/pick-box.js";
import { TextBox } from "../../lib/slider.js";
import { mayEdit } from "../../model/connection.js";
import { robot } from "../../model/document.js";
import {
  fixedFrame,
  kinds,
  listenTo,
  poseNow,
  setProperty,
  settingOf,
  topicsNow,
} from "../../model/live-displays.js";
import { Choice, PropertyEditor } from "../property-editor.js";

const POSE_EVERY_MS = 1000;

/** @param {DisplayView} display @param {number} level @param {(id: string) => boolean} isOpen @returns {Row[]} */
export function settingsOf(display, level, isOpen) {
  const kind = kinds.value.get(display.kind);
  // One of a config file that there is not here has no settings that could be shown.
  if (!kind && kinds.value.size > 0) return [];
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
        ...(property?.doc && { help: { title: path, text: property.doc } }),
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
      help: {
        title: t("live.topic"),
        text: t("live.topic.help", { types: kind.types.join(", ") }),
      },
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
      help: { title: t("live.listening"), text: t("live.listening.help") },
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
    html`<${Choice} label=${t(`live.qos.${name}`)} value=${String(wished[name])} disabled=${!mayEdit.value}
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

/** @param {{display: DisplayView, property: PropertyView}} props the widget of a property */
function Editor({ display, property }) {
  return html`<${PropertyEditor} label=${`${display.name}: ${property.name}`} property=${property} disabled=${!mayEdit.value}
    value=${settingOf(display, property.name) ?? property.default} set=${(
      /** @type {boolean | number | string} */ one,
    ) => void setProperty(display.id, property.name, one)} />`;
}
