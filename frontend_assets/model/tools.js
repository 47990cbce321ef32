/**
 * Tools of the 3D view: which the document has, which this person has in hand, and what is sent
 * with them. The list is shared; the tool in hand is a person's own.
 */

/** @import { ToolKindView, ToolUsed, ToolView } from "../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { Studio3d } from "./viewport.js" */

import { computed, effect, signal } from "vendor/preact.js";
import { addCommands } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { latestValues } from "../lib/latest.js";
import { mayAct } from "./connection.js";
import { robot } from "./document.js";
import { fixedFrame, liveDisplays } from "./live-displays.js";
import { ask } from "./requests.js";
import { isFree, notify } from "./view.js";
import { viewport } from "./viewport.js";
import { subscribe } from "./wire.js";

/** @typedef {boolean | number | string} Value */
/** @typedef {{x: number, y: number, z?: number, yaw?: number}} Pointed a place in the fixed frame, m, and a direction, rad */

/** In the order of the toolbar. @type {Signal<readonly ToolView[]>} */
export const tools = signal([]);
/** Kinds of tools, once somebody asked for them. @type {Signal<ReadonlyMap<string, ToolKindView>>} */
export const toolKinds = signal(new Map());
/** Id of what was taken; empty, or gone: Interact. */
const taken = signal("");

/** Publishing takes control of the robot. @param {ToolView} tool */
export const mayTake = (tool) => tool.publishes === "" || mayAct.value;

/** @type {(kind: string) => ToolView | undefined} the first of a kind */
const firstOf = (kind) => tools.value.find((one) => one.kind === kind);

/** What this person has in hand; null before the list is known. */
export const toolInHand = computed(() => {
  const found = tools.value.find(({ id }) => id === taken.value);
  return (found && mayTake(found) ? found : firstOf("Interact")) ?? null;
});

subscribe("tools", (event) => {
  tools.value = event.tools;
});

/** @param {string} id of a tool */
export function takeTool(id) {
  taken.value = id;
}

/** Back to Interact. */
export const putToolAway = () => takeTool("");

/** Take the first tool of a kind, as its key does. @param {string} kind */
export function takeKind(kind) {
  const tool = firstOf(kind);
  if (tool && mayTake(tool)) takeTool(tool.id);
}

/** @param {string} kind */
export const hasKind = (kind) => firstOf(kind) !== undefined;

/** @param {string} kind @param {string} [name] */
export const addTool = (kind, name = "") => ask({ type: "add_tool", kind, name });
/** @param {string} tool */
export const removeTool = (tool) => ask({ type: "remove_tool", tool });
/** @param {string} tool @param {string} name */
export const renameTool = (tool, name) => ask({ type: "rename_tool", tool, name });

/** @type {ReturnType<typeof latestValues<Value>>} */
const properties = latestValues((tool, name, value) =>
  ask({ type: "set_tool_property", tool, name, value }),
);

/** @param {ToolView} tool @param {string} name @returns {Value | undefined} as it is, or as it is about to be */
export const toolValue = ({ id, values }, name) => properties.coming(id, name) ?? values[name];

/** Of a tool, by its id and the name of the property; the newest wins, and is shown at once. */
export const setToolProperty = properties.set;

/** Have the kinds of tools be known; asked for once. */
export async function needToolKinds() {
  if (toolKinds.value.size > 0) return;
  const answer = await ask({ type: "get_tool_kinds" });
  if (answer?.type === "tool_kinds")
    toolKinds.value = new Map(answer.kinds.map((one) => [one.kind, one]));
}

/** Publish with a tool, or send a goal; what became of it is said. @param {ToolView} tool @param {Pointed} pointed
 * @returns {Promise<boolean>} whether it was sent */
export async function useTool(tool, { x, y, z = 0, yaw = 0 }) {
  const place = { x, y, z, yaw, fixed_frame: fixedFrame.value };
  const answer = await ask({ type: "use_tool", tool: tool.id, ...place });
  if (answer?.type !== "tool_used") return false;
  const isUnheard = answer.sent_as === "topic" && answer.subscriptions === 0;
  notify(sentWords(tool.name, answer), { bad: isUnheard });
  return true;
}

/** @param {string} tool @param {ToolUsed} answer @returns {string} */
function sentWords(tool, { sent_as, name, frame, subscriptions }) {
  if (sent_as === "action") return t("tool.sent.goal", { tool, name, frame });
  const words = subscriptions > 0 ? "tool.sent" : "tool.sent.unheard";
  return t(words, { tool, name, frame });
}

/** Whether a tool goes back where it was after one use. @param {ToolView} tool */
export const isOneShot = ({ values }) => values["Single click"] !== false;

/** @param {Pointed} pointed with the tool in hand */
function onPointed(pointed) {
  const tool = toolInHand.value;
  if (!tool?.publishes) return;
  if (isOneShot(tool)) putToolAway();
  void useTool(tool, pointed);
}

/** Keys as RViz has them, and icons; Measure has a command of its own. */
const KEYS = /** @type {const} */ ([
  ["Interact", "I", "interact"],
  ["MoveCamera", "M", "move"],
  ["Select", "S", "select"],
  ["FocusCamera", "C", "crosshair"],
  ["SetInitialPose", "P", "pose"],
  ["SetGoal", "G", "goal"],
  ["PublishPoint", "U", "pin"],
]);

export function addTools() {
  addCommands([
    ...KEYS.map(([kind, key, icon]) => ({
      id: `tool.${kind}`,
      label: () => firstOf(kind)?.name ?? kind,
      icon,
      keys: [key],
      enabled: () => canTake(kind),
      run: () => (toolInHand.value?.kind === kind ? putToolAway() : takeKind(kind)),
    })),
    {
      id: "tool_back",
      icon: "close",
      keys: ["Escape"],
      enabled: () => isFree() && !["Interact", undefined].includes(toolInHand.value?.kind),
      run: () => viewport.value?.cancelTool() || putToolAway(),
    },
  ]);
  effect(() => (viewport.value ? tell(viewport.value) : undefined));
  // With control that comes back nobody expects the tool of before in the hand.
  effect(() => {
    if (toolInHand.value && toolInHand.value.id !== taken.value) putToolAway();
  });
}

/** @param {string} kind */
function canTake(kind) {
  const tool = firstOf(kind);
  return robot.value !== null && tool !== undefined && mayTake(tool) && isFree();
}

/** @param {Studio3d} view @returns {() => void} the end of it */
function tell(view) {
  const stop = new AbortController();
  /** @param {string} type @param {(detail: any) => void} take */
  const on = (type, take) =>
    view.events.addEventListener(type, (event) => take(/** @type {CustomEvent} */ (event).detail), {
      signal: stop.signal,
    });
  on("pose", onPointed);
  on("point", ({ point: [x, y, z] }) => onPointed({ x, y, z }));
  on("focus", () => {
    if (toolInHand.value?.kind === "FocusCamera") putToolAway();
  });
  const ends = [
    effect(() => view.setTool(toolInHand.value?.kind ?? "Interact")),
    effect(() => {
      for (const tool of oneOfEach()) view.setToolProperties(tool.kind, tool.values);
    }),
    effect(() => {
      const displays = Object.fromEntries(liveDisplays.value.map(({ id, name }) => [id, name]));
      view.setWords({ displays, floor: t("tool.floor"), nothing: t("tool.nothing") });
    }),
  ];
  return () => {
    stop.abort();
    for (const end of ends) end();
  };
}

/** @returns {ToolView[]} one of each kind: that in hand, or the first */
function oneOfEach() {
  const all = [...tools.value].reverse().map((one) => /** @type {const} */ ([one.kind, one]));
  const byKind = new Map(all);
  if (toolInHand.value) byKind.set(toolInHand.value.kind, toolInHand.value);
  return [...byKind.values()];
}
