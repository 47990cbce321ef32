import assert from "node:assert/strict";
import { test } from "node:test";

const { itemsOf } = await import("../../frontend_assets/panels/scene/marker-parts.js");

const entry = (
  /** @type {number} */ id,
  parent = 0,
  checked = /** @type {boolean | null} */ (null),
) => ({
  id,
  parent,
  title: `Entry ${id}`,
  checked,
});

test("a menu has its entries in order, boxes where they have one, and lists below others", () => {
  /** @type {number[]} */
  const chosen = [];
  const items = itemsOf([entry(1), entry(2), entry(3, 2, true), entry(4, 0, false)], 0, (id) =>
    chosen.push(id),
  );
  assert.deepEqual(
    items.map(({ label, box }) => [label, box]),
    [
      ["Entry 1", undefined],
      ["Entry 2", undefined],
      ["Entry 4", false],
    ],
  );
  items[0]?.run?.();
  const below = items[1]?.more?.() ?? [];
  assert.deepEqual(
    below.map(({ label, box }) => [label, box]),
    [["Entry 3", true]],
  );
  below[0]?.run?.();
  assert.deepEqual(chosen, [1, 3]);
});
