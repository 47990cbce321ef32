/** The graph that a launch file would make, as far as its remaps tell: drawn as the node graph is. */

/** @import { Plan } from "../../types/wire.d.ts" */
/** @import { Arrow, Box } from "../graph/nodes.js" */

import { html, useSignal } from "vendor/preact.js";
import { t } from "../../lib/i18n.js";
import { baseName } from "../../lib/paths.js";
import { EmptyState } from "../../lib/ui.js";
import { showSource } from "../../model/source.js";
import { GraphDrawing } from "../graph/drawing.js";

/** @param {{plan: Plan}} props */
export function LaunchGraph({ plan }) {
  const chosen = useSignal("");
  const drawn = plannedGraph(plan);
  if (drawn.boxes.length === 0)
    return html`<${EmptyState} icon="graph" title=${t("launching.nodes.none")} />`;
  const open = (/** @type {Box} */ box) => {
    const node = plan.nodes.find(({ id }) => box.id === `node:${id}`);
    if (node?.where.line) showSource(node.where.file, node.where.line);
  };
  return html`<div class="launching-graph"><p class="note padded">${t("launching.graph.hint")}</p>
    <${GraphDrawing} drawn=${drawn} asked=${plan.file} rates=${new Map()} chosen=${chosen} onFocus=${open} /></div>`;
}

/**
 * @param {Plan} plan
 * @returns {{boxes: Box[], arrows: Arrow[]}} nodes that would run, the file that names each, and the names that they are given
 */
export function plannedGraph(plan) {
  const files = new Map(plan.includes.map(({ id, file }) => [id, file]));
  /** @type {Map<string, Box>} */
  const boxes = new Map();
  /** @type {Map<string, Arrow>} */
  const arrows = new Map();
  const put = (/** @type {Box} */ box) => {
    boxes.set(box.id, box);
    return box;
  };
  const join = (/** @type {Box} */ from, /** @type {Box} */ to, /** @type {string} */ name) => {
    const id = `${from.id} ${to.id}`;
    arrows.set(id, { id, from: from.id, to: to.id, names: [name] });
  };
  for (const node of plan.nodes.filter(({ condition }) => condition?.holds !== false)) {
    const box = boxOf(`node:${node.id}`, "node", node.full_name || nameOf(node));
    put(box);
    const file = baseName(files.get(node.include ?? -1) ?? plan.file);
    if (plan.includes.length > 0) join(put(boxOf(`service:${file}`, "service", file)), box, file);
    for (const { target: given } of node.remaps) {
      const target = given.startsWith("/") ? given : `${withSlash(node.namespace)}${given}`;
      join(box, put(boxOf(`topic:${target}`, "topic", target)), target);
    }
  }
  return { boxes: [...boxes.values()], arrows: [...arrows.values()] };
}

/** @param {string} id @param {Box["kind"]} kind @param {string} name @returns {Box} */
const boxOf = (id, kind, name) => ({ id, kind, name, count: 1 });

/** @param {Plan["nodes"][number]} node */
const nameOf = ({ namespace, name, executable }) => `${withSlash(namespace)}${name || executable}`;

/** @param {string} namespace */
const withSlash = (namespace) => (namespace.endsWith("/") ? namespace : `${namespace}/`);
