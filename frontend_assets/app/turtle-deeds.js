/** What a person has turtlesim do: each is a call of one of its services. */

/** @import { Point } from "../lib/turtle-field.js" */
/** @import { Pen } from "../lib/turtles.js" */

import { signal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { serviceNamed } from "../lib/turtles.js";
import { called } from "./calling.js";
import { services } from "./state/offers.js";

/** Why the last one was not done; empty: it was. */
export const turtleTrouble = signal("");

/** @param {string} name @returns {boolean} somebody serves it */
export const isServed = (name) => serviceNamed(services.value ?? [], name) !== null;

/** @param {string} name of the service @param {object} values @returns {Promise<any>} its reply; null: there is none, which is said */
async function ask(name, values) {
  const service = serviceNamed(services.peek() ?? [], name);
  const { reply, trouble } = service
    ? await called(service, values)
    : { reply: null, trouble: t("turtlesim.not_served", { name }) };
  turtleTrouble.value = trouble;
  return reply;
}

/** @param {string} prefix @param {Point} place m @param {string} name empty: turtlesim gives one @returns {Promise<string>} the name that it got; empty: there is none */
export async function spawn(prefix, { x, y }, name) {
  const reply = await ask(`${prefix}/spawn`, { x, y, theta: 0, name });
  if (reply && !reply.name) turtleTrouble.value = t("turtlesim.not_spawned", { name });
  return reply?.name ?? "";
}

/** @param {string} prefix @param {string} name */
export const kill = (prefix, name) => ask(`${prefix}/kill`, { name });
/** @param {string} prefix */
export const clear = (prefix) => ask(`${prefix}/clear`, {});
/** @param {string} prefix */
export const reset = (prefix) => ask(`${prefix}/reset`, {});
/** @param {string} path of the turtle @param {Point & {theta: number}} place m, m and rad */
export const teleport = (path, { x, y, theta }) =>
  ask(`${path}/teleport_absolute`, { x, y, theta });

/** @param {string} path of the turtle @param {Pen} pen */
export const setPen = (path, { color, width, isDown }) =>
  ask(`${path}/set_pen`, {
    ...{ r: (color >> 16) & 255, g: (color >> 8) & 255, b: color & 255 },
    ...{ width, off: isDown ? 0 : 1 },
  });
