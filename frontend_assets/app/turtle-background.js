/** The three parameters of a turtlesim that say what its bare ground looks like. */

import { signal } from "vendor/preact.js";
import { plainOf } from "../lib/deeds.js";
import { latestSender } from "../lib/latest.js";
import { bytesOf, colorOf } from "../lib/turtles.js";
import { lookAt } from "./data.js";
import { askOrKeepWhy } from "./state/refusals.js";

const NAMES = /** @type {const} */ (["background_r", "background_g", "background_b"]);
/** So often at most the node is asked. */
const REST_MS = 150;
/** What others change may hide what this one did at the same moment. */
const OTHERS_REST_MS = 2000;

/** Why the node did not take the colour that was chosen last. */
export const backgroundRefused = signal("");

/**
 * @param {string} node full name
 * @param {(color: number) => void} tell at first and at every change, 0xrrggbb
 * @returns {() => void} the end of it
 */
export function followBackground(node, tell) {
  const sender = latestSender(
    async () => {
      const color = await backgroundOf(node);
      if (color !== null) tell(color);
    },
    (go) => setTimeout(go, REST_MS),
  );
  let asked_ms = 0;
  const ask = () => {
    asked_ms = performance.now();
    sender.push(undefined);
  };
  ask();
  backgroundRefused.value = "";
  const onMessage = (/** @type {{value: any}} */ { value }) => {
    if (value?.node === node || performance.now() - asked_ms > OTHERS_REST_MS) ask();
  };
  const events = { onState: () => {}, onMessage };
  return lookAt("/parameter_events", { mostHz: 60 }, events).leave;
}

/** @param {string} node @returns {Promise<number | null>} null: it does not tell */
async function backgroundOf(node) {
  const told = await askOrKeepWhy({ type: "get_parameters", node }, signal(""));
  if (told?.type !== "parameters") return null;
  const known = new Map(told.parameters.map(({ name, value }) => [name, plainOf(value)]));
  const bytes = NAMES.map((name) => known.get(name));
  const isColor = bytes.every((one) => typeof one === "number" && one >= 0 && one <= 255);
  return isColor ? colorOf(.../** @type {[number, number, number]} */ (bytes)) : null;
}

/** @type {ReturnType<typeof latestSender<{node: string, hex: string}>>} */
const setter = latestSender(setNow);

/** @param {string} node @param {string} hex the newest wins */
export const setBackground = (node, hex) => setter.push({ node, hex });

/** @param {{node: string, hex: string}} wished */
async function setNow({ node, hex }) {
  backgroundRefused.value = "";
  const bytes = bytesOf(hex);
  for (const [n, name] of NAMES.entries()) {
    const refused = signal("");
    const text = String(bytes[n]);
    await askOrKeepWhy({ type: "set_parameter", node, name, text, value_type: "integer" }, refused);
    if (refused.value) backgroundRefused.value = refused.value;
  }
}
