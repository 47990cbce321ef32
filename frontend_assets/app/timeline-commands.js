/** What can be done with the time of the document by name: for the palette, for keys and for menus. */

/** @import { Command } from "../lib/commands.js" */

import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { sinceStart } from "../lib/timeline.js";
import { mayManage } from "../model/connection.js";
import { bagPart } from "../model/recording.js";
import {
  addBookmark,
  goLive,
  hasTimeline,
  isPast,
  loopFromNow,
  loopTime,
  mayMoveTime,
  now_s,
  playTime,
  seekTime,
  stepTime,
  timeState,
  timeZoom,
  wholeTime,
} from "../model/time.js";
import { dialog, isFree, notify } from "../model/view.js";

const mayMove = () => hasTimeline.value && mayMoveTime.value && isFree();
/** Now has nothing to play: it goes on by itself. */
const mayPlay = () => mayMove() && isPast.value;
/** Who waits for a place to look back from waits no more. */
const mayGoLive = () => mayMove() && (isPast.value || (timeState.value?.queue ?? 0) > 0);

/** @returns {Command[]} */
export function timeCommands() {
  return [
    {
      id: "time.play",
      label: () => t(timeState.value?.playing ? "timeline.pause" : "timeline.play"),
      icon: "animate",
      keys: ["Space"],
      enabled: mayPlay,
      run: () => void playOrPause(),
    },
    {
      id: "time.back",
      icon: "stepBack",
      keys: [","],
      enabled: mayMove,
      run: () => void stepTime(false),
    },
    {
      id: "time.forward",
      icon: "stepForward",
      keys: ["."],
      enabled: mayPlay,
      run: () => void stepTime(true),
    },
    { id: "time.live", icon: "live", keys: ["L"], enabled: mayGoLive, run: () => void goLive() },
    {
      id: "time.begin",
      icon: "skipBack",
      enabled: mayMove,
      run: () => void seekTime(wholeTime.peek().from_s),
    },
    { id: "time.loop", icon: "loop", enabled: mayPlay, run: toggleLoop },
    { id: "time.loop_begin", icon: "loop", enabled: mayPlay, run: () => void loopFromNow(true) },
    { id: "time.loop_end", icon: "loop", enabled: mayPlay, run: () => void loopFromNow(false) },
    { id: "time.bookmark", icon: "bookmark", enabled: mayMove, run: bookmarkNow },
    ...bagCommands(),
  ];
}

/** @returns {Command[]} */
function bagCommands() {
  return [
    {
      id: "open_bag",
      icon: "bag",
      enabled: () => mayManage.value && isFree(),
      run: () => {
        dialog.value = { kind: "open", tab: "browse" };
      },
    },
    {
      id: "record_bag",
      icon: "bag",
      enabled: isFree,
      run: () => showBagPart("record"),
    },
  ];
}

/** @param {import("../model/recording.js").BagPart} part */
export function showBagPart(part) {
  bagPart.value = part;
  commandById("panel.bag")?.run();
}

/** From its end a recording begins anew. */
async function playOrPause() {
  const state = timeState.peek();
  if (!state) return;
  const isAtEnd = now_s.peek() >= wholeTime.peek().to_s - 1e-6;
  if (!state.playing && isAtEnd && state.mode === "bag") await seekTime(wholeTime.peek().from_s);
  await playTime(!state.playing);
}

/** What is seen of it is played again and again; or no longer. */
export function toggleLoop() {
  if (timeState.peek()?.loop) void loopTime(null);
  else void loopTime(timeZoom.peek() ?? wholeTime.peek());
}

/** It is named after its time, until somebody has a word for it. */
export async function bookmarkNow() {
  const state = timeState.peek();
  if (!state) return;
  const time = sinceStart(now_s.peek() - state.begin_s, 1);
  if (!(await addBookmark(t("timeline.bookmark.name", { time })))) return;
  const run = () => showBagPart("contents");
  notify(t("timeline.bookmark.added", { time }), {
    action: { label: t("timeline.bookmark.rename"), run },
  });
}
