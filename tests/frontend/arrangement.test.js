import assert from "node:assert/strict";
import { test } from "node:test";
import {
  fromDockview,
  readArrangement,
  tabsOf,
  toDockview,
} from "../../frontend_assets/lib/arrangement.js";

/** @import { Arrangement, Split } from "../../frontend_assets/lib/arrangement.js" */

/** @type {Arrangement} */
const MODEL = {
  upright: false,
  parts: [
    { tabs: ["displays", "outline"], size: 300, shown: "outline" },
    {
      split: [
        { tabs: ["scene"], size: 500 },
        { tabs: ["source"], size: 300 },
      ],
      size: 700,
    },
  ],
};
const ROOM = { width: 2000, height: 1600, gap: 0 };
const KNOWN = new Set(["displays", "outline", "scene", "source"]);

/** @param {string} id */
const isKnown = (id) => KNOWN.has(id);

test("an arrangement fills the room that there is, and comes back from the dock as it was", () => {
  const dock = toDockview(MODEL, ROOM, (id) => ({ id }));
  const back = fromDockview(dock);
  assert.deepEqual(back.parts.flatMap(tabsOf), MODEL.parts.flatMap(tabsOf));
  assert.deepEqual(
    back.parts.map(({ size }) => size),
    [600, 1400],
  );
  const [, right] = back.parts;
  assert.ok(right && "split" in right);
  assert.deepEqual(
    right.split.map(({ size }) => size),
    [1000, 600],
  );
  assert.equal(Object.keys(dock.panels).length, 4);
});

test("what the dock shows between its gaps is arranged again as it is", () => {
  const gap = 8;
  /** What the dock tells of is without the share of the gaps. @type {(parts: Split[]) => Split[]} */
  const shown = (parts) =>
    parts.map((part) => {
      const size = part.size - (gap * (parts.length - 1)) / parts.length;
      return "split" in part ? { split: shown(part.split), size } : { ...part, size };
    });
  const arrange = (/** @type {Split[]} */ parts) =>
    shown(fromDockview(toDockview({ parts }, { ...ROOM, gap }, (id) => ({ id }))).parts);
  const once = arrange(MODEL.parts);
  assert.equal(
    once.reduce((sum, { size }) => sum + size, gap),
    ROOM.width,
  );
  assert.deepEqual(arrange(once), once);
});

test("parts may stand above one another at the outermost, too", () => {
  const dock = toDockview({ ...MODEL, upright: true }, ROOM, (id) => ({ id }));
  assert.equal(dock.grid.orientation, "VERTICAL");
  assert.equal(fromDockview(dock).upright, true);
});

test("what was stored is read as it is", () => {
  assert.deepEqual(readArrangement(JSON.parse(JSON.stringify(MODEL)), isKnown), {
    arrangement: MODEL,
    dropped: [],
  });
});

test("panels that are not known, or there twice, are left out, and so are places left empty", () => {
  const stored = {
    parts: [
      { tabs: ["plot"], size: 1 },
      {
        split: [
          { tabs: ["scene", "tf", "scene"], size: 2 },
          { tabs: ["scene"], size: 3 },
        ],
        size: 4,
      },
    ],
  };
  assert.deepEqual(readArrangement(stored, isKnown), {
    arrangement: { upright: false, parts: [{ split: [{ tabs: ["scene"], size: 2 }], size: 4 }] },
    dropped: ["plot", "tf"],
  });
});

test("what is no arrangement is not taken for one", () => {
  for (const wrong of [null, 7, "x", [], {}, { parts: 3 }, { parts: [] }, { parts: [null, 4, {}] }])
    assert.equal(readArrangement(wrong, isKnown), null);
  assert.equal(readArrangement({ parts: [{ tabs: ["plot"], size: 1 }] }, isKnown), null);
});

test("sizes that are none, and a front that is not there, do no harm", () => {
  const stored = {
    parts: [
      { tabs: ["scene", 3, {}], size: -5, shown: "source" },
      { tabs: ["source"], size: "wide" },
    ],
  };
  assert.deepEqual(readArrangement(stored, isKnown)?.arrangement.parts, [
    { tabs: ["scene"], size: 1 },
    { tabs: ["source"], size: 1 },
  ]);
});

test("a tree without an end is cut", () => {
  /** @type {{split: object[], size: number} | {tabs: string[], size: number}} */
  let deep = { tabs: ["scene"], size: 1 };
  for (let n = 0; n < 5000; n += 1) deep = { split: [deep], size: 1 };
  assert.equal(readArrangement({ parts: [deep] }, isKnown), null);
});

test("a window over the panels keeps its place in a room of another size", () => {
  const window = {
    tabs: ["source"],
    shown: "source",
    left: 0.25,
    top: 0.5,
    width: 0.25,
    height: 0.5,
  };
  const parts = [{ tabs: ["displays"], size: 1, shown: "displays" }];
  const dock = toDockview({ upright: false, parts, floating: [window] }, ROOM, (id) => ({ id }));
  assert.deepEqual(Object.keys(dock.panels), ["displays", "source"]);
  assert.deepEqual(dock.floatingGroups?.[0]?.position, {
    left: 500,
    top: 800,
    width: 500,
    height: 800,
  });
  assert.deepEqual(fromDockview(dock).floating, [window]);
});

test("a window that hangs on other sides, or holds groups side by side, becomes one with tabs", () => {
  const position = { right: 200, bottom: 100, width: 400, height: 300 };
  const leaf = (/** @type {string} */ id) => ({ type: "leaf", data: { views: [id] } });
  const grid = { root: { type: "branch", data: [leaf("source"), leaf("outline")] } };
  const dock = toDockview({ parts: [{ tabs: ["scene"], size: 1 }] }, ROOM, (id) => ({ id }));
  const { floating } = fromDockview(
    /** @type {any} */ ({ ...dock, floatingGroups: [{ grid, position }] }),
  );
  assert.deepEqual(floating, [
    { tabs: ["source", "outline"], left: 0.7, top: 0.75, width: 0.2, height: 0.1875 },
  ]);
});

test("windows from a file are few, inside the room, and hold no panel that stands elsewhere", () => {
  const far = { tabs: ["source", "displays", "moon"], left: 9, top: -3, width: 0.5, height: "x" };
  const read = readArrangement(
    { parts: [{ tabs: ["displays"], size: 1 }], floating: [null, far, { tabs: [] }, 7] },
    isKnown,
  );
  assert.deepEqual(read?.arrangement.floating, [
    { tabs: ["source"], left: 0.5, top: 0, width: 0.5, height: 0.4 },
  ]);
  assert.deepEqual(read?.dropped, ["moon"]);
  const many = Array.from({ length: 500 }, () => ({ tabs: ["source"] }));
  const again = readArrangement({ parts: [{ tabs: ["scene"], size: 1 }], floating: many }, isKnown);
  assert.equal(again?.arrangement.floating?.length, 1);
});
