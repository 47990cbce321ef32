/** The parameters of the node that is looked at, as the studio told them and their changes. */

/** @import { ParametersChanged, ParameterView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { signal } from "vendor/preact.js";

/** Full name; empty: none is looked at. */
export const chosenNode = signal("");
/** Of that node; null: not told yet. @type {Signal<readonly ParameterView[] | null>} */
export const parameters = signal(null);
/** Why a node did not set a parameter at last, by name. @type {Signal<ReadonlyMap<string, string>>} */
export const setRefused = signal(new Map());

/** @param {ParametersChanged} event */
export function takeParameterNews({ node, parameters: changed, gone }) {
  const known = parameters.value;
  if (node !== chosenNode.value || !known) return;
  const byName = new Map(known.map((one) => [one.name, one]));
  for (const { name, value, value_type } of changed) {
    const before = byName.get(name);
    byName.set(
      name,
      before ? { ...before, value, value_type } : { ...bare(name), value, value_type },
    );
  }
  for (const name of gone) byName.delete(name);
  parameters.value = [...byName.values()].sort((a, b) => (a.name < b.name ? -1 : 1));
}

/** @param {string} name @returns {ParameterView} of which nothing is known */
const bare = (name) => ({
  ...{ name, value_type: "", value: "null", description: "", read_only: false },
  ...{ constraints: "", low: null, high: null, step: 0 },
});
