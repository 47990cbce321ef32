/** Properties as the rows of a list: the three numbers of a place share one. */

/** @import { PropertyView } from "../types/wire.d.ts" */

/**
 * @param {readonly PropertyView[]} properties in their order
 * @param {(name: string) => unknown} now what another property is, on which one may depend
 * @returns {{label: string, properties: PropertyView[]}[]}
 */
export function propertyRows(properties, now) {
  /** @type {Map<string, PropertyView[]>} */
  const rows = new Map();
  for (const one of properties) {
    const values = /** @type {readonly unknown[]} */ (one.when_values);
    if (one.when !== "" && !values.includes(now(one.when))) continue;
    const label = one.name.replace(/\/[XYZ]$/, "");
    rows.set(label, [...(rows.get(label) ?? []), one]);
  }
  return [...rows].map(([label, own]) => ({ label, properties: own }));
}
