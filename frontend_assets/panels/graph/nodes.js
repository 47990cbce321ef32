/**
 * Who speaks with whom, as boxes and arrows: which of them are shown, how they hang together, and
 * the nodes of one namespace as one box.
 */

/** @import { GraphLinkView, GraphNodeView } from "../../types/wire.d.ts" */

/** @typedef {{nodes: readonly GraphNodeView[], links: readonly GraphLinkView[]}} Graph */
/**
 * @typedef {object} GraphOptions
 * @property {"links" | "nodes"} form topics as boxes between nodes, or as words on the arrows
 * @property {boolean} noise what every node has is shown, too, and what is hidden
 * @property {boolean} sinks topics that nobody publishes or nobody hears are shown, too
 * @property {boolean} services calls and goals are shown, too
 * @property {boolean} spaces nodes of one namespace are one box, where nothing is sought
 * @property {ReadonlySet<string>} opened namespaces whose nodes are shown all the same
 * @property {string} words in a name of what is shown
 * @property {string} focus id of a box: only what is near it is shown; empty: all
 */
/** @typedef {"node" | "space" | "topic" | "service" | "action"} BoxKind `space`: a namespace */
/** @typedef {{id: string, kind: BoxKind, name: string, count: number, bridge?: string}} Box `count`: nodes of that name, or in that namespace; `bridge`: to DDS, that all of them are behind */
/** @typedef {{id: string, from: string, to: string, names: readonly string[]}} Arrow `names` of what it carries */

/** @type {GraphOptions} */
export const USUAL = {
  form: "links",
  noise: false,
  sinks: false,
  services: false,
  spaces: false,
  opened: new Set(),
  words: "",
  focus: "",
};

const NOISE = new Set(["/rosout", "/parameter_events", "/clock"]);
const OF_EVERY_NODE =
  /\/(describe_parameters|get_parameters|get_parameter_types|list_parameters|set_parameters|set_parameters_atomically|get_type_description|get_logger_levels|set_logger_levels)$/;
/** So many steps from the box in focus a box is still shown: over topics, the next nodes. */
const NEAR_STEPS = 2;

/** @param {BoxKind} kind @param {string} name */
const boxId = (kind, name) => `${kind}:${name}`;

/** @param {Graph} whole @param {GraphOptions} options @returns {{boxes: Box[], arrows: Arrow[]}} */
export function drawnGraph(whole, options) {
  const { spaces, opened, words, focus } = options;
  return drawnNodes(spaces && !words && !focus ? byNamespace(whole, opened) : whole, options);
}

/** @param {Graph} graph @param {GraphOptions} options @returns {{boxes: Box[], arrows: Arrow[]}} */
function drawnNodes(graph, options) {
  const links = graph.links.filter((link) => isShown(link, options));
  const whole = options.form === "links" ? withLinks(graph, links) : nodesOnly(graph, links);
  const kept = keptIds(whole, options);
  const isNamed = (/** @type {Box} */ { id }) => kept.has(id);
  return {
    boxes: whole.boxes.filter(isNamed),
    arrows: whole.arrows.filter(({ from, to }) => kept.has(from) && kept.has(to)),
  };
}

/** @param {GraphLinkView} link @param {GraphOptions} options */
function isShown({ kind, name, hidden, sources, targets }, { noise, sinks, services }) {
  if (kind !== "topic" && !services) return false;
  const isNoise = hidden || NOISE.has(name) || (kind === "service" && OF_EVERY_NODE.test(name));
  if (isNoise && !noise) return false;
  // A service without a caller is the rule, and says nothing about who speaks with whom.
  return (sinks && kind === "topic") || (sources.length > 0 && targets.length > 0);
}

/** @param {Graph} graph @param {readonly GraphLinkView[]} links */
function withLinks(graph, links) {
  /** @type {Arrow[]} */
  const arrows = [];
  const nameOf = (/** @type {number} */ at) => boxId("node", graph.nodes[at]?.name ?? "");
  for (const { kind, name, sources, targets } of links) {
    const id = boxId(kind, name);
    for (const at of sources) arrows.push(arrow(nameOf(at), id, [name]));
    for (const at of targets) arrows.push(arrow(id, nameOf(at), [name]));
  }
  const boxes = links.map(({ kind, name }) => ({
    id: boxId(kind, name),
    kind,
    name,
    count: 1,
  }));
  return { boxes: [...nodeBoxes(graph, arrows), ...boxes], arrows };
}

/** @param {Graph} graph @param {readonly GraphLinkView[]} links */
function nodesOnly(graph, links) {
  /** @type {Map<string, {from: string, to: string, names: string[]}>} */
  const between = new Map();
  for (const { name, sources, targets } of links)
    for (const source of sources)
      for (const target of targets) {
        const from = boxId("node", graph.nodes[source]?.name ?? "");
        const to = boxId("node", graph.nodes[target]?.name ?? "");
        const known = between.get(`${from} ${to}`) ?? { from, to, names: [] };
        known.names.push(name);
        between.set(`${from} ${to}`, known);
      }
  const arrows = [...between.values()].map(({ from, to, names }) => arrow(from, to, names));
  return { boxes: nodeBoxes(graph, arrows), arrows };
}

/** @param {string} from @param {string} to @param {readonly string[]} names @returns {Arrow} */
const arrow = (from, to, names) => ({ id: `${from} ${to}`, from, to, names });

/** @param {Graph} graph @param {readonly Arrow[]} arrows @returns {Box[]} every node of others, and those of the studio that speak with somebody */
function nodeBoxes(graph, arrows) {
  const speaking = new Set(arrows.flatMap(({ from, to }) => [from, to]));
  return graph.nodes
    .map(({ name, count, own, bridge }) => ({
      id: boxId("node", name),
      own,
      name,
      count,
      bridge,
    }))
    .filter(({ id, own }) => !own || speaking.has(id))
    .map(({ id, name, count, bridge }) => ({ id, kind: nodeKind(name), name, count, bridge }));
}

/** @param {string} name @returns {BoxKind} */
const nodeKind = (name) => (isNamespace(name) ? "space" : "node");

/** @param {{boxes: readonly Box[], arrows: readonly Arrow[]}} whole @param {GraphOptions} options @returns {Set<string>} what is near the focus, or near what has the words in its name */
function keptIds({ boxes, arrows }, { words, focus }) {
  const all = new Set(boxes.map(({ id }) => id));
  if (focus !== "" && all.has(focus)) return near(new Set([focus]), arrows, NEAR_STEPS);
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean);
  if (wanted.length === 0) return all;
  const isMeant = (/** @type {string} */ name) =>
    wanted.every((one) => name.toLowerCase().includes(one));
  const found = boxes.filter(({ name }) => isMeant(name)).map(({ id }) => id);
  const carrying = arrows.filter(({ names }) => names.some(isMeant));
  return new Set([
    ...near(new Set(found), arrows, 1),
    ...carrying.flatMap(({ from, to }) => [from, to]),
  ]);
}

/** @param {Set<string>} ids @param {readonly Arrow[]} arrows @param {number} steps @returns {Set<string>} they and what is so many arrows away at most */
function near(ids, arrows, steps) {
  let reached = ids;
  for (let step = 0; step < steps; step += 1) {
    const more = arrows
      .filter(({ from, to }) => reached.has(from) || reached.has(to))
      .flatMap(({ from, to }) => [from, to]);
    reached = new Set([...reached, ...more]);
  }
  return reached;
}

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
  const places = graph.nodes.map(({ name, count, own, bridge }) => {
    const shown = nameOf(name);
    const known = found.get(shown) ?? {
      name: shown,
      count: 0,
      own: true,
      bridge,
      at: found.size,
    };
    found.set(shown, {
      ...known,
      count: known.count + count,
      own: known.own && own,
      bridge: known.bridge === bridge ? bridge : "",
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
