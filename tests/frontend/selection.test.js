import assert from "node:assert/strict";
import { test } from "node:test";
import { changedBy, described, idOf } from "../../frontend_assets/model/selected-items.js";
import {
  cssColour,
  middleOf,
  nameOf,
  rowsOf,
} from "../../frontend_assets/panels/selection/selection.js";

/** @import { ItemView } from "../../frontend_assets/types/wire.d.ts" */
/** @import { Selected } from "../../frontend_assets/model/selected-items.js" */

/** @param {string} display @param {string} key @param {Partial<ItemView>} [news] @returns {ItemView} */
const view = (display, key, news = {}) => ({
  ...{ display, key, kind: "marker", name: key, path: "0", frame: "map", stamp: "" },
  ...{ place: /** @type {[number, number, number]} */ ([1, 2, 3]), box: null, shape: "" },
  ...news,
});
/** @param {string} display @param {string} key @param {Partial<Selected>} [news] @returns {Selected} */
const item = (display, key, news = {}) => ({
  ...{ ref: { display, key }, view: view(display, key), gone: false },
  ...news,
});
/** @param {...Selected} items */
const mapOf = (...items) => new Map(items.map((one) => [idOf(one.ref), one]));

test("a click replaces, Shift adds and Ctrl takes away", () => {
  const before = mapOf(item("d1", "a"));
  const keys = (/** @type {import("../../frontend_assets/model/selected-items.js").How} */ how) => [
    ...changedBy(before, [{ display: "d1", key: "b" }], how).keys(),
  ];
  assert.deepEqual(keys("replace"), ["d1 b"]);
  assert.deepEqual(keys("add"), ["d1 a", "d1 b"]);
  assert.deepEqual(keys("remove"), ["d1 a"]);
  assert.equal(changedBy(before, [{ display: "d1", key: "a" }], "remove").size, 0);
  const again = changedBy(before, [{ display: "d1", key: "a" }], "replace");
  assert.equal(again.get("d1 a"), before.get("d1 a"), "what is known of it stays known");
});

test("there are so many items at most", () => {
  const refs = Array.from({ length: 5000 }, (_, at) => ({ display: "d1", key: String(at) }));
  assert.equal(changedBy(new Map(), refs, "replace").size, 4000);
});

test("what is not described any more is gone, and comes back with its next message", () => {
  const before = mapOf(item("d1", "a"), item("d1", "b"));
  const after = described(before, new Map([["d1 a", view("d1", "a", { place: [4, 5, 6] })]]));
  assert.deepEqual(after.get("d1 a")?.view?.place, [4, 5, 6]);
  assert.deepEqual(after.get("d1 b")?.view?.place, [1, 2, 3], "as it was last");
  assert.equal(after.get("d1 b")?.gone, true);
  assert.equal(described(after, new Map([["d1 b", view("d1", "b")]])).get("d1 b")?.gone, false);
});

test("items stand by their display, and their middle is that of all whose place is known", () => {
  const items = [item("d2", "a"), item("d1", "b"), item("d2", "c", { gone: true })];
  assert.deepEqual(
    rowsOf(items, new Map()).map(({ id }) => id),
    ["d2 ", "d2 a", "d2 c", "d1 ", "d1 b"],
  );
  const closed = rowsOf(items, new Map([["d2", false]]));
  assert.deepEqual(
    closed.map(({ id }) => id),
    ["d2 ", "d1 ", "d1 b"],
  );
  const many = Array.from({ length: 51 }, (_, at) => item("d3", String(at)));
  assert.equal(rowsOf(many, new Map()).length, 1, "of many the name alone, until it is opened");
  assert.equal(rowsOf(many, new Map([["d3", true]])).length, 52);
  const moved = item("d1", "b", { view: view("d1", "b", { place: [3, 4, 5] }) });
  assert.deepEqual(middleOf([...items, moved]), [5 / 3, 8 / 3, 11 / 3]);
  assert.equal(middleOf([item("d1", "x", { view: null })]), null);
});

test("an item has its key for a name until it is known, and colours are those of ROS", () => {
  assert.equal(nameOf(item("d1", "k", { view: null })), "k");
  assert.equal(nameOf(item("d1", "k")), "selection.kind.marker k");
  assert.equal(cssColour([1, 0.5, 0, 2]), "rgb(255 128 0 / 1)");
});
