/** Nodes of one namespace as one box, for graphs that are too large to be read node by node. */

/** @import { GraphNodeView } from "../types/wire.d.ts" */
/** @import { Graph } from "./node-graph.js" */

/** More nodes are drawn by their namespaces, unless somebody wishes otherwise. */
export const READABLE_NODES = 60;

/** @param {string} name of a box @returns {boolean} it is a namespace, with its last slash */
export const isNamespace = (name) => name.endsWith("/");

/** @param {string} name of a node, or of a namespace @returns {string[]} the namespaces that it is in, the widest first */
export function namespacesOf(name) {
  const parts = name.split("/").slice(1, isNamespace(name) ? -2 : -1);
  return parts.map((_, at) => `/${parts.slice(0, at + 1).join("/")}/`);
}

/** @param {readonly GraphNodeView[]} nodes @param {string} namespace @returns {string[]} names of those in it */
export const namesWithin = (nodes, namespace) =>
  nodes.map(({ name }) => name).filter((name) => name.startsWith(namespace));

/**
 * @param {Graph} graph
 * @param {ReadonlySet<string>} opened namespaces whose nodes are shown, or the namespaces in them
 * @returns {Graph} nodes that share a namespace are one, named as that with its last slash
 */
export function byNamespace(graph, opened) {
  const sizes = sizesOf(graph.nodes);
  const nameOf = (/** @type {string} */ name) =>
    namespacesOf(name).find((one) => !opened.has(one) && (sizes.get(one) ?? 0) > 1) ?? name;
  /** @type {Map<string, GraphNodeView & {at: number}>} */
  const found = new Map();
  const places = graph.nodes.map(({ name, count, own }) => {
    const shown = nameOf(name);
    const known = found.get(shown) ?? {
      name: shown,
      count: 0,
      own: true,
      at: found.size,
    };
    found.set(shown, {
      ...known,
      count: known.count + count,
      own: known.own && own,
    });
    return known.at;
  });
  const moved = (/** @type {readonly number[]} */ ends) => [
    ...new Set(ends.map((at) => places[at] ?? -1)),
  ];
  const links = graph.links.map((link) => ({
    ...link,
    sources: moved(link.sources),
    targets: moved(link.targets),
  }));
  const nodes = [...found.values()];
  return {
    nodes,
    links: links.filter(({ sources, targets }) => !isWithin(nodes, sources, targets)),
  };
}

/** @param {readonly GraphNodeView[]} nodes @returns {Map<string, number>} how many nodes each namespace has */
function sizesOf(nodes) {
  /** @type {Map<string, number>} */
  const sizes = new Map();
  for (const { name } of nodes)
    for (const one of namespacesOf(name)) sizes.set(one, (sizes.get(one) ?? 0) + 1);
  return sizes;
}

/** @param {readonly GraphNodeView[]} nodes @param {readonly number[]} sources @param {readonly number[]} targets @returns {boolean} what joins the nodes of one namespace is not seen outside of it */
function isWithin(nodes, sources, targets) {
  const [at = -1, ...others] = new Set([...sources, ...targets]);
  return others.length === 0 && isNamespace(nodes[at]?.name ?? "");
}
