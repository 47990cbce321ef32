/** Places at which a ROS 2 system was looked for: where, in which domain, and what is spoken. */

/** @import { ExamineWire } from "../types/wire.d.ts" */

/** @typedef {{address: string, domain: number, distro: NonNullable<ExamineWire["distro"]>}} Place `distro` empty: as it was */

export const DISTROS = /** @type {const} */ (["jazzy", "kilted", "humble"]);
export const DOMAIN_MAX = 232;
const KEPT = 6;

/** @param {unknown} value @returns {value is Place} */
export function isPlace(value) {
  if (typeof value !== "object" || value === null) return false;
  const { address, domain, distro } = /** @type {Record<string, unknown>} */ (value);
  return typeof address === "string" && typeof distro === "string" && isDomain(Number(domain));
}

/** @param {number} domain */
export const isDomain = (domain) => Number.isInteger(domain) && domain >= 0 && domain <= DOMAIN_MAX;

/** @param {Place} one @param {Place} other */
export const isSamePlace = (one, other) =>
  one.address === other.address && one.domain === other.domain && one.distro === other.distro;

/** @param {readonly Place[]} places @param {Place} place @returns {Place[]} it first, each once, and not too many */
export const withRecent = (places, place) =>
  [place, ...places.filter((one) => !isSamePlace(one, place))].slice(0, KEPT);

/** @param {string} endpoint as Zenoh writes it @returns {string} the machine that is meant; empty: this one, or none */
export function hostOf(endpoint) {
  const host = endpoint.replace(/^[^/]*\//, "").replace(/:\d+([?#].*)?$/, "");
  return /^(localhost|127\.[\d.]+|\[::1\])$/.test(host) ? "" : host;
}
