/** What a camera sees: the newest image of a topic, its numbers, and a copy of it. */

/** @import { TopicRow } from "../types/wire.d.ts" */
/** @import { Picture, Range } from "../lib/image-pixels.js" */
/** @import { Heard } from "../workers/wishes.js" */
/** @import { Pictured } from "../workers/pictures.js" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { ConnectFirst, isUnconnected } from "../app/connect-first.js";
import { laneOpen, watch } from "../app/data.js";
import { useLooking } from "../app/looking.js";
import { topics } from "../app/state/topics.js";
import { followTopics } from "../app/topics.js";
import { saveAsFile } from "../lib/files.js";
import { t } from "../lib/i18n.js";
import { rateOf } from "../lib/image-view.js";
import { formatNumber } from "../lib/numbers.js";
import { EmptyState, Icon, IconButton, MenuButton, ProgressBar, Switch } from "../lib/ui.js";
import { ImageCanvas } from "./image-canvas.js";

const TYPES = ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"];
const TIMES_MAX = 30;

export function ImagePanel() {
  const { panel, looking } = useLooking(followTopics);
  const chosen = useSignal("");
  return html`<section ref=${panel} class="panel-body image" aria-label=${t("panel.image")}>
    ${isUnconnected() ? html`<${ConnectFirst} icon="camera" />` : looking && html`<${Content} chosen=${chosen} />`}
  </section>`;
}

/** @param {{chosen: Signal<string>}} props */
function Content({ chosen }) {
  if (!topics.value) return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
  const choices = topics.value.filter(({ types }) => types.some((type) => TYPES.includes(type)));
  const topic = chosen.value || (choices[0]?.name ?? "");
  if (!topic)
    return html`<${EmptyState} icon="camera" title=${t("image.none")}><p>${t("image.none.hint")}</p><//>`;
  const type = choices.find(({ name }) => name === topic)?.types.find((one) => TYPES.includes(one));
  return html`<${Watched} key=${topic} topic=${topic} type=${type ?? ""} choices=${choices} chosen=${chosen} />`;
}

/** @typedef {{topic: string, choices: readonly TopicRow[], chosen: Signal<string>}} Choice */

/** @param {Choice & {type: string}} props */
function Watched({ topic, type, choices, chosen }) {
  const heard = useSignal(/** @type {Heard | null} */ (null));
  const pictured = useSignal(/** @type {Pictured | null} */ (null));
  const times_s = useRef(/** @type {number[]} */ ([]));
  const range = useSignal(/** @type {Range | null} */ (null));
  const watching = useRef(/** @type {ReturnType<typeof watch> | null} */ (null));
  const pointed = useSignal("");
  useEffect(() => {
    const made = watch(topic, { typeName: type }, range.value, {
      onState: (told) => {
        heard.value = told;
      },
      onPicture: (came) => {
        const isNew = came.received_s !== times_s.current.at(-1);
        if (isNew) times_s.current = [...times_s.current.slice(1 - TIMES_MAX), came.received_s];
        pictured.value = came;
      },
    });
    watching.current = made;
    return made.leave;
  }, [topic, type]);
  const shade = (/** @type {Range | null} */ wished) => {
    range.value = wished;
    watching.current?.shade(wished);
  };
  const picture = pictured.value?.picture ?? null;
  return html`<${Bar} topic=${topic} choices=${choices} chosen=${chosen} picture=${picture} />
    ${picture?.values && html`<${RangeRow} picture=${picture} range=${range.value} onRange=${shade} />`}
    ${
      picture
        ? html`<${ImageCanvas} picture=${picture} label=${t("image.of", { topic })} pointed=${pointed} />`
        : html`<p class="image-said" role="status">${stateWords(heard.value, pictured.value)}</p>`
    }
    ${picture && pictured.value && html`<${Facts} pictured=${pictured.value} picture=${picture} rate=${rateOf(times_s.current)} pointed=${pointed.value} isStill=${heard.value?.state !== "hearing" || !laneOpen.value} />`}`;
}

/** @param {Choice & {picture: Picture | null}} props */
function Bar({ topic, choices, chosen, picture }) {
  const items = () =>
    choices.map(({ name }) => ({
      label: name,
      checked: name === topic,
      run: () => {
        chosen.value = name;
      },
    }));
  return html`<div class="panel-bar image-bar">
    <${MenuButton} label=${t("image.topic")} hint=${topic} class="button" items=${items}><span class="image-topic">${topic}</span><${Icon} name="chevronDown" size=${12} /><//>
    <span class="push"></span>
    <${IconButton} icon="download" label=${t("image.save")} disabled=${!picture} onClick=${() => picture && savePicture(topic, picture)} />
  </div>`;
}

/** @param {string} topic @param {Picture} picture */
function savePicture(topic, { width, height, rgba }) {
  const canvas = document.createElement("canvas");
  Object.assign(canvas, { width, height });
  canvas.getContext("2d")?.putImageData(new ImageData(rgba, width, height), 0, 0);
  const name = `${topic.slice(1).replaceAll("/", "_")}.png`;
  canvas.toBlob((blob) => blob && saveAsFile(name, blob, "image/png"));
}

/** @param {{picture: Picture, range: Range | null, onRange: (range: Range | null) => void}} props from which number on it is black, and from which on white */
function RangeRow({ picture, range, onRange }) {
  const box = (
    /** @type {"low" | "high"} */ end,
  ) => html`<label class="image-end">${t(`image.${end}`)}
    <input type="number" step="any" class="box" value=${formatNumber(picture.range[end], 5)} disabled=${range === null}
      onChange=${(/** @type {any} */ event) => onRange({ ...picture.range, [end]: event.currentTarget.valueAsNumber || 0 })} /></label>`;
  return html`<div class="panel-bar image-range" role="group" aria-label=${t("image.range")}>
    <${Switch} label=${t("image.auto")} checked=${range === null} onChange=${(/** @type {boolean} */ isAuto) => onRange(isAuto ? null : picture.range)} /><span aria-hidden="true">${t("image.auto_short")}</span>
    ${box("low")}${box("high")}${picture.unit && html`<span class="muted">${picture.unit}</span>`}
  </div>`;
}

/** @param {{pictured: Pictured, picture: Picture, rate: number | null, pointed: string, isStill: boolean}} props */
function Facts({ pictured, picture, rate, pointed, isStill }) {
  const size = { width: picture.width, height: picture.height };
  const words = [
    t("image.size", size),
    pictured.encoding,
    rate === null || isStill ? "" : t("image.rate", { rate: rate.toFixed(1) }),
    t("image.kilobytes", { count: Math.ceil(pictured.bytes / 1000) }),
    isStill ? t("image.still") : "",
  ];
  return html`<p class="image-facts"><span class="muted">${words.filter(Boolean).join(" · ")}</span><output>${pointed}</output></p>`;
}

/** @param {Heard | null} heard @param {Pictured | null} pictured @returns {string} why there is no picture, and what to do */
function stateWords(heard, pictured) {
  if (!laneOpen.value) return t("topics.state.lane");
  if (pictured?.trouble) return t(pictured.trouble.key, pictured.trouble.words);
  if (!heard) return t("loading");
  if (heard.state === "hearing") return t("image.waiting");
  return heard.reason || t(`topics.state.${heard.state}`, { types: heard.types.join(", ") });
}
