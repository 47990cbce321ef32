/**
 * Boxes in layers, so that arrows point down: loops are cut, boxes take the layer below the lowest
 * above them, long arrows get a place in each layer that they cross, and each layer is ordered so
 * that few arrows cross. Parts that do not hang together stand beside one another.
 */

/** @import { Box } from "./nodes.js" */

/** @typedef {{id: string, width: number, height: number}} Sized px */
/** @typedef {{id: string, from: string, to: string}} Joined */
/** @typedef {{x: number, y: number}} Point centre of a box, px */
/** @typedef {{boxes: Map<string, Point>, arrows: Map<string, Point[]>, width: number, height: number}} Layout */
/** @typedef {{id: string, width: number, layer: number, x: number, above: Cell[], below: Cell[]}} Cell a box, or where an arrow crosses a layer */

const GAP_X = 26;
const GAP_Y = 46;
const GAP_PARTS = 44;
const SWEEPS = 10;
const SHAPE = 1.7;
/** Width where an arrow crosses a layer. */
const CROSSING = 10;

/** @param {readonly Sized[]} boxes @param {readonly Joined[]} arrows both ends are among the boxes @param {number} [shape] width by height that it would best have @returns {Layout} */
export function layOut(boxes, arrows, shape = SHAPE) {
  const parts = partsOf(boxes, arrows).map((part) => layOutPart(part.boxes, part.arrows));
  return placed(parts, shape);
}

/** @param {readonly Sized[]} boxes @param {readonly Joined[]} arrows @returns {{boxes: Sized[], arrows: Joined[]}[]} what hangs together, the largest first */
function partsOf(boxes, arrows) {
  /** @type {Map<string, string>} */
  const heads = new Map(boxes.map(({ id }) => [id, id]));
  const headOf = (/** @type {string} */ id) => {
    let head = id;
    while (heads.get(head) !== head) head = heads.get(head) ?? head;
    heads.set(id, head);
    return head;
  };
  for (const { from, to } of arrows) heads.set(headOf(from), headOf(to));
  /** @type {Map<string, {boxes: Sized[], arrows: Joined[]}>} */
  const parts = new Map();
  for (const box of boxes) {
    const head = headOf(box.id);
    const part = parts.get(head) ?? { boxes: [], arrows: [] };
    part.boxes.push(box);
    parts.set(head, part);
  }
  for (const one of arrows) parts.get(headOf(one.from))?.arrows.push(one);
  return [...parts.values()].sort((a, b) => b.boxes.length - a.boxes.length);
}

/** @param {readonly Sized[]} boxes @param {readonly Joined[]} arrows @returns {Layout} */
function layOutPart(boxes, arrows) {
  const layerOf = layersOf(boxes, downward(boxes, arrows));
  const { layers, ways } = cellsOf(boxes, arrows, layerOf);
  for (let sweep = 0; sweep < SWEEPS; sweep += 1) order(layers, sweep % 2 === 0);
  for (let sweep = 0; sweep < SWEEPS; sweep += 1) align(layers, sweep % 2 === 0);
  return measured(boxes, layers, ways);
}

/** @param {readonly Sized[]} boxes @param {readonly Joined[]} arrows @returns {Joined[]} the same without loops: those that lead back are turned round */
function downward(boxes, arrows) {
  const out = grouped(arrows, ({ from }) => from);
  /** @type {Map<string, "open" | "done">} */
  const state = new Map();
  /** @type {Joined[]} */
  const kept = [];
  const reached = new Set(arrows.map(({ to }) => to));
  const starts = [...boxes].sort((a, b) => Number(reached.has(a.id)) - Number(reached.has(b.id)));
  for (const { id } of starts) if (!state.has(id)) goDown(id, out, state, kept);
  return kept;
}

/**
 * Follow the arrows from one box on, without recursion: a chain may be long.
 *
 * @param {string} first @param {ReadonlyMap<string, readonly Joined[]>} out
 * @param {Map<string, "open" | "done">} state of the boxes that were met @param {Joined[]} kept is added to
 */
function goDown(first, out, state, kept) {
  const stack = [{ id: first, next: 0 }];
  state.set(first, "open");
  for (let top = stack.at(-1); top; top = stack.at(-1)) {
    const one = out.get(top.id)?.[top.next];
    top.next += 1;
    if (!one) {
      state.set(top.id, "done");
      stack.pop();
      continue;
    }
    if (one.from === one.to) continue;
    kept.push(state.get(one.to) === "open" ? { ...one, from: one.to, to: one.from } : one);
    if (state.has(one.to)) continue;
    state.set(one.to, "open");
    stack.push({ id: one.to, next: 0 });
  }
}

/** @param {readonly Sized[]} boxes @param {readonly Joined[]} arrows without loops @returns {Map<string, number>} */
function layersOf(boxes, arrows) {
  const into = grouped(arrows, ({ to }) => to);
  const out = grouped(arrows, ({ from }) => from);
  const layer = deepest(boxes, into, out);
  // What nothing leads to stands right above the first that it leads to.
  for (const { id } of boxes) {
    const next = (out.get(id) ?? []).map(({ to }) => layer.get(to) ?? 0);
    if (!into.has(id) && next.length > 0) layer.set(id, Math.min(...next) - 1);
  }
  return layer;
}

/** @param {readonly Sized[]} boxes @param {ReadonlyMap<string, readonly Joined[]>} into @param {ReadonlyMap<string, readonly Joined[]>} out @returns {Map<string, number>} each below all that lead to it */
function deepest(boxes, into, out) {
  const waiting = new Map(boxes.map(({ id }) => [id, into.get(id)?.length ?? 0]));
  const layer = new Map(boxes.map(({ id }) => [id, 0]));
  const ready = boxes.map(({ id }) => id).filter((id) => waiting.get(id) === 0);
  for (let id = ready.shift(); id !== undefined; id = ready.shift())
    for (const { to } of out.get(id) ?? []) {
      layer.set(to, Math.max(layer.get(to) ?? 0, (layer.get(id) ?? 0) + 1));
      waiting.set(to, (waiting.get(to) ?? 0) - 1);
      if (waiting.get(to) === 0) ready.push(to);
    }
  return layer;
}

/** @param {readonly Sized[]} boxes @param {readonly Joined[]} arrows @param {ReadonlyMap<string, number>} layerOf */
function cellsOf(boxes, arrows, layerOf) {
  /** @type {Cell[][]} */
  const layers = [];
  const add = (
    /** @type {string} */ id,
    /** @type {number} */ width,
    /** @type {number} */ layer,
  ) => {
    /** @type {Cell} */
    const cell = { id, width, layer, x: 0, above: [], below: [] };
    layers[layer] ??= [];
    layers[layer]?.push(cell);
    return cell;
  };
  const cells = new Map(
    boxes.map((box) => [box.id, add(box.id, box.width, layerOf.get(box.id) ?? 0)]),
  );
  /** @type {Map<string, Cell[]>} */
  const ways = new Map();
  for (const { id, from, to } of arrows) {
    const [first, last] = [cells.get(from), cells.get(to)];
    if (!first || !last || first === last) continue;
    const way = wayBetween(first, last, (layer) => add(`${id} ${layer}`, CROSSING, layer));
    ways.set(id, way);
  }
  return { layers: Array.from(layers, (layer) => layer ?? []), ways };
}

/** @param {Cell} first @param {Cell} last @param {(layer: number) => Cell} cross @returns {Cell[]} from the one to the other, a layer at a time */
function wayBetween(first, last, cross) {
  const step = Math.sign(last.layer - first.layer);
  const way = [first];
  for (let layer = first.layer + step; step !== 0 && layer !== last.layer; layer += step)
    way.push(cross(layer));
  way.push(last);
  for (const [at, cell] of way.slice(1).entries()) {
    const before = way[at];
    if (!before || before.layer === cell.layer) continue;
    const [upper, lower] = before.layer < cell.layer ? [before, cell] : [cell, before];
    upper.below.push(lower);
    lower.above.push(upper);
  }
  return way;
}

/** @param {Cell[][]} layers @param {boolean} down each layer by the mean place of its neighbours in the one before */
function order(layers, down) {
  const sequence = down ? layers : layers.toReversed();
  for (const layer of sequence) {
    layer.forEach((cell, at) => {
      cell.x = at;
    });
  }
  for (const layer of sequence) {
    const wanted = new Map(
      layer.map((cell) => [cell, mean(down ? cell.above : cell.below) ?? cell.x]),
    );
    layer.sort((a, b) => (wanted.get(a) ?? 0) - (wanted.get(b) ?? 0));
    layer.forEach((cell, at) => {
      cell.x = at;
    });
  }
}

/** @param {Cell[][]} layers @param {boolean} down each cell as near below, or above, its neighbours as there is room */
function align(layers, down) {
  for (const layer of down ? layers : layers.toReversed()) {
    const wanted = layer.map((cell) => mean(down ? cell.above : cell.below) ?? cell.x);
    spread(layer, wanted);
  }
}

/** @param {readonly Cell[]} layer @param {readonly number[]} wanted in their order, none over another, and together as near to the wanted as one shift makes them */
function spread(layer, wanted) {
  let free = Number.NEGATIVE_INFINITY;
  layer.forEach((cell, at) => {
    cell.x = Math.max(wanted[at] ?? 0, free + cell.width / 2);
    free = cell.x + cell.width / 2 + GAP_X;
  });
  const shift = layer.reduce((sum, cell, at) => sum + (wanted[at] ?? 0) - cell.x, 0) / layer.length;
  for (const cell of layer) cell.x += shift;
}

/** @param {readonly Cell[]} cells @returns {number | null} */
const mean = (cells) =>
  cells.length === 0 ? null : cells.reduce((sum, { x }) => sum + x, 0) / cells.length;

/** @param {readonly Sized[]} boxes @param {readonly Cell[][]} layers @param {ReadonlyMap<string, readonly Cell[]>} ways @returns {Layout} from 0, 0 on */
function measured(boxes, layers, ways) {
  const height = Math.max(...boxes.map((box) => box.height));
  const cells = layers.flat();
  const left = Math.min(...cells.map(({ x, width }) => x - width / 2));
  const right = Math.max(...cells.map(({ x, width }) => x + width / 2));
  const pointOf = (/** @type {Cell} */ { x, layer }) => ({
    x: x - left,
    y: height / 2 + layer * (height + GAP_Y),
  });
  const ids = new Set(boxes.map(({ id }) => id));
  return {
    boxes: new Map(cells.filter(({ id }) => ids.has(id)).map((cell) => [cell.id, pointOf(cell)])),
    arrows: new Map([...ways].map(([id, way]) => [id, way.map(pointOf)])),
    width: right - left,
    height: height + (layers.length - 1) * (height + GAP_Y),
  };
}

/** @param {readonly Layout[]} parts @param {number} shape @returns {Layout} in rows that together have about that shape */
function placed(parts, shape) {
  const area = parts.reduce(
    (sum, { width, height }) => sum + (width + GAP_PARTS) * (height + GAP_PARTS),
    0,
  );
  const widest = Math.max(Math.sqrt(area * shape), ...parts.map(({ width }) => width), 0);
  /** @type {Layout} */
  const whole = { boxes: new Map(), arrows: new Map(), width: 0, height: 0 };
  let [x, y, rowHeight] = [0, 0, 0];
  for (const part of parts) {
    if (x > 0 && x + part.width > widest) [x, y, rowHeight] = [0, y + rowHeight + GAP_PARTS, 0];
    const moved = (/** @type {Point} */ point) => ({
      x: point.x + x,
      y: point.y + y,
    });
    for (const [id, point] of part.boxes) whole.boxes.set(id, moved(point));
    for (const [id, way] of part.arrows) whole.arrows.set(id, way.map(moved));
    whole.width = Math.max(whole.width, x + part.width);
    whole.height = Math.max(whole.height, y + part.height);
    x += part.width + GAP_PARTS;
    rowHeight = Math.max(rowHeight, part.height);
  }
  return whole;
}

/** @template T @param {readonly T[]} items @param {(item: T) => string} keyOf @returns {Map<string, T[]>} */
function grouped(items, keyOf) {
  /** @type {Map<string, T[]>} */
  const groups = new Map();
  for (const item of items) {
    const key = keyOf(item);
    const group = groups.get(key);
    if (group) group.push(item);
    else groups.set(key, [item]);
  }
  return groups;
}

const LETTER_PX = 6.7;
const AROUND_PX = 22;
export const BOX_HEIGHT_PX = 26;
const LETTERS_MAX = 34;

/** @param {string} name @returns {string} names differ at their ends: of a long one the beginning goes */
export function boxWords(name) {
  const letters = [...name];
  return letters.length <= LETTERS_MAX ? name : `…${letters.slice(1 - LETTERS_MAX).join("")}`;
}

/** @param {Box} box @returns {string} of a namespace also how many nodes are in it */
export const boxLabel = ({ kind, name, count }) =>
  kind === "space" ? `${boxWords(name)} ${count}` : boxWords(name);

/** @param {Box} box @returns {number} px */
export const boxWidth = (box) => Math.round([...boxLabel(box)].length * LETTER_PX + AROUND_PX);
