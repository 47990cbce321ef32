/** What a topic says now, as a tree; who is at its ends, and how it is listened to. */

/** @import { TopicRow } from "../types/wire.d.ts" */
/** @import { Heard, Looked } from "../workers/subscriptions.js" */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { ListeningMenu } from "../app/listening-menu.js";
import { copyText } from "../lib/clipboard.js";
import { t } from "../lib/i18n.js";
import { shortTime, useSilence } from "../lib/times.js";
import { Icon, IconButton } from "../lib/ui.js";
import { mayEdit } from "../model/connection.js";
import { laneOpen, lookAt } from "../model/data-lane.js";
import { addDisplay } from "../model/live-displays.js";
import { chosenTopic, listening } from "../model/topics.js";
import { notify } from "../model/view.js";
import { EchoTree } from "./topics-echo-tree.js";
import { TopicEnds } from "./topics-ends.js";

/** @typedef {ReturnType<typeof lookAt>} Look */

/** @param {{topic: string, row: TopicRow | undefined}} props */
export function TopicEcho({ topic, row }) {
  const heard = useSignal(/** @type {Heard | null} */ (null));
  const message = useSignal(/** @type {Looked | null} */ (null));
  const paused = useSignal(false);
  const showsEnds = useSignal(false);
  const look = useRef(/** @type {Look | null} */ (null));
  const silence = useSilence();
  const newest_s = useRef(0);
  const { reliable, latched } = listening.value;
  useEffect(() => {
    const made = lookAt(
      topic,
      { reliable, latched, pace: "at_once" },
      {
        onState: (told) => {
          heard.value = told;
        },
        onMessage: (came) => {
          if (came.received_s !== newest_s.current) silence.came();
          newest_s.current = came.received_s;
          if (!paused.value) message.value = came;
        },
      },
    );
    look.current = made;
    return made.leave;
  }, [topic, reliable, latched]);
  return html`<section class="topics-echo" aria-label=${t("topics.echo.of", { topic })}>
    <div class="panel-bar topics-head">
      <strong title=${topic}>${topic}</strong>
      <span class="push"></span>
      <${IconButton} icon="info" label=${t("topics.connections")} pressed=${showsEnds.value} onClick=${() => {
        showsEnds.value = !showsEnds.value;
      }} />
      <${ListeningMenu} label=${t("topics.qos")} listening=${listening} hint=${heard.value ? qosWords(heard.value) : undefined} />
      ${row?.kind && mayEdit.value && html`<${IconButton} icon="scene" label=${t("topics.show", { kind: row.kind })} onClick=${() => addDisplay(row.kind, topic)} />`}
      <${IconButton} icon="copy" label=${t("topics.copy_message")} disabled=${!message.value} onClick=${() => copyAt(look.current, "")} />
      <${IconButton} icon=${paused.value ? "animate" : "pause"} label=${t(paused.value ? "topics.go_on" : "topics.pause")} pressed=${paused.value} onClick=${() => {
        paused.value = !paused.value;
      }} />
      <${IconButton} icon="close" label=${t("topics.echo.close")} onClick=${() => {
        chosenTopic.value = null;
      }} />
    </div>
    <${TopicEnds} topic=${topic} listed=${showsEnds.value} />
    <${Said} heard=${heard.value} message=${message.value} silent_s=${silence.silent_s} />
    ${
      message.value?.value &&
      html`<${EchoTree} topic=${topic} type=${heard.value?.type_name ?? ""} value=${message.value.value}
      onMore=${(/** @type {string} */ path, /** @type {number} */ count) => look.current?.unfold(path, count)}
      onCopy=${(/** @type {string} */ path) => copyAt(look.current, path)} />`
    }
    ${message.value?.hex && html`<pre class="topics-hex scroll" tabindex=${0}>${message.value.hex}</pre>`}
  </section>`;
}

/** @param {Look | null} look @param {string} path */
async function copyAt(look, path) {
  const text = (await look?.text(path)) ?? "";
  const done = await copyText(text);
  notify(done ? t("topics.copied") : t("copy.failed"), { bad: !done });
}

/** @param {Heard} heard @returns {string} */
const qosWords = ({ reliable, latched }) =>
  [
    t(reliable ? "topics.qos.reliable" : "topics.qos.best_effort"),
    latched ? t("topics.qos.latched") : "",
  ]
    .filter(Boolean)
    .join(", ");

/** @param {{heard: Heard | null, message: Looked | null, silent_s: number}} props what is heard, or what is in the way and what to do */
function Said({ heard, message, silent_s }) {
  if (heard === null) return html`<p class="topics-said muted" role="status">${t("loading")}</p>`;
  const trouble = troubleOf(heard, message, silent_s);
  const words = [
    heard.type_name,
    message ? t("topics.bytes", { count: message.bytes }) : "",
    message && message.lost > 0 ? t("topics.lost", { count: message.lost }) : "",
  ];
  return html`<p class="topics-said" role="status"><span class="muted">${words.filter(Boolean).join(" · ")}</span>
    ${trouble && html`<span class="topics-trouble"><${Icon} name="alert" size=${13} /><span>${trouble}</span></span>`}</p>`;
}

/** @param {Heard} heard @param {Looked | null} message @param {number} silent_s @returns {string} empty: all is well */
function troubleOf(heard, message, silent_s) {
  if (!laneOpen.value) return t("topics.state.lane");
  if (heard.state === "refused") return heard.reason;
  if (heard.state !== "hearing")
    return t(`topics.state.${heard.state}`, { types: heard.types.join(", ") });
  if (message?.trouble) return t("topics.unread", { reason: message.trouble.replace(/\.$/, "") });
  if (!message) return t("topics.state.waiting");
  // What is latched is said once and holds.
  return silent_s > 0 && !heard.latched
    ? t("topics.state.silent", { time: shortTime(silent_s) })
    : "";
}
