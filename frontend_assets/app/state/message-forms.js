/** Forms of messages: what was chosen, its values as fields or as YAML, and why it cannot be sent. */

/** @import { FormMessage, Types } from "../../lib/message-form.js" */

import { computed, signal } from "vendor/preact.js";
import { blank, fromPlain, isWrong, yamlOf } from "../../lib/message-form.js";
import { askOrKeepWhy } from "./refusals.js";

/** @typedef {{name: string, type: string}} Chosen a service, an action or a topic, and its type */
/** @typedef {ReturnType<typeof messageForm>} MessageForm */

/** A form of its own for each panel: what is typed stays while the panel is behind another one. */
export function messageForm() {
  const chosen = signal(/** @type {Chosen | null} */ (null));
  const types = signal(/** @type {Types} */ (new Map()));
  /** The message that is filled in: of a call its request, of an action its goal. */
  const root = signal("");
  const value = signal(/** @type {FormMessage | string} */ ({}));
  const text = signal("");
  const inYaml = signal(false);
  const trouble = signal("");
  const wrong = computed(() => !inYaml.value && isWrong(types.value, root.value, value.value));
  const isKnown = computed(() => types.value.has(root.value));
  /** The values that the text says, which is then shown as it was written. @type {FormMessage | string | null} */
  let written = null;

  /** @param {Chosen} choice */
  const ofType = ({ type }) => askOrKeepWhy({ type: "get_interface", name: type }, trouble);

  /** @param {Chosen} choice @param {string} [yaml] empty: all defaults */
  async function open(choice, yaml = "") {
    chosen.value = choice;
    [types.value, root.value, value.value, text.value] = [new Map(), "", {}, yaml];
    [trouble.value, inYaml.value, written] = ["", false, null];
    const told = await ofType(choice);
    if (chosen.peek() !== choice) return;
    if (told?.type !== "interface") {
      inYaml.value = true;
      return;
    }
    types.value = new Map(told.messages.map((one) => [one.name, one]));
    root.value = told.parts[0] ?? "";
    value.value = blank(types.value, root.value);
    if (yaml.trim()) await toFields();
  }

  /** See whether the text can be read; gives what it says, null where it cannot or was changed meanwhile. */
  async function check() {
    const choice = chosen.peek();
    const asked = { name: choice?.type ?? "", text: text.peek() };
    const told = await askOrKeepWhy({ type: "read_values", ...asked }, trouble);
    const isOld = chosen.peek() !== choice || text.peek() !== asked.text;
    return isOld || told?.type !== "values_read" ? null : told.values;
  }

  /** Have the fields say what the text says; it stays a text where they cannot. */
  async function toFields() {
    const values = await check();
    inYaml.value = values === null;
    if (values === null) return;
    value.value = fromPlain(types.value, root.value, JSON.parse(values));
    written = value.value;
  }

  function toYaml() {
    if (value.value !== written) text.value = yaml();
    inYaml.value = true;
  }

  const yaml = () => (inYaml.value ? text.value : yamlOf(types.value, root.value, value.value));

  const close = () => {
    chosen.value = null;
  };
  return {
    ...{ chosen, types, root, value, text, inYaml, trouble, wrong, isKnown },
    ...{ open, close, check, toFields, toYaml, yaml },
  };
}

export const serviceForm = messageForm();
export const goalForm = messageForm();
export const publishForm = messageForm();
/** Seconds that a service has for its answer. */
export const callTimeout = signal(10);
/** How a message is published: so often a second, and with which quality of service. */
export const publishing = signal({ rate_hz: 1, reliable: true, latched: false, depth: 10 });
