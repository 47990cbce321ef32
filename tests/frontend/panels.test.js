import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { placedPanels, withoutRunning } from "../../frontend_assets/app/layouts.js";
import { PANEL_GROUPS, readPanels } from "../../frontend_assets/app/panels.js";
import { ICON_NAMES, PANEL_FILES, PANEL_IDS } from "./support/panels.js";

/** What a layout is made of. */
const PARTS = {
  wide: ["left", "middle", "below", "right"],
  medium: ["middle", "below", "right"],
  live: ["left", "middle", "below", "upper", "lower"],
  workspace: ["left", "middle", "below", "right"],
  phone: ["tabs"],
};
const LAYOUTS = /** @type {(keyof typeof PARTS)[]} */ (Object.keys(PARTS));

for (const [id, { group, icon, places = {}, words }] of Object.entries(PANEL_FILES))
  test(`the panel ${id} has a group, an icon, a title, known places, and its component`, () => {
    assert.match(id, /^[a-z][a-z\d]*$/);
    assert.ok(PANEL_GROUPS.includes(group));
    assert.ok(typeof icon === "string" ? ICON_NAMES.includes(icon) : icon.length > 0);
    for (const [layout, place] of Object.entries(places)) {
      const [, part = "", at] = /^(\w+)(?: (\d+))?$/.exec(place) ?? [];
      assert.ok(
        PARTS[/** @type {keyof typeof PARTS} */ (layout)].includes(part),
        `${layout} ${at}`,
      );
    }
    for (const [language, ofLanguage] of Object.entries(words))
      assert.ok(ofLanguage[`panel.${id}`], language);
    const code = readFileSync(
      new URL(`../../frontend_assets/panels/${id}/${id}.js`, import.meta.url),
      "utf8",
    );
    assert.match(
      code,
      new RegExp(`^export function ${id[0]?.toUpperCase()}${id.slice(1)}Panel\\(`, "m"),
    );
  });

test("panels come in their order, and one that gives none comes last", () => {
  const file = (/** @type {number | undefined} */ order) =>
    /** @type {any} */ ({ group: "watch", icon: "box", ...(order && { order }) });
  const panels = readPanels({ late: file(undefined), second: file(20), first: file(10) });
  assert.deepEqual(Object.keys(panels), ["first", "second", "late"]);
  assert.equal(panels.first?.badge(), null);
});

test("an icon of a panel's own is named as the panel", () => {
  const own = readPanels({ box: { group: "watch", icon: [["path", { d: "M0 0h1" }]] } });
  assert.equal(own.box?.icon, "box");
});

test("a place is a part of a layout and a number among its tabs; without one it is the last", () => {
  const panels = {
    last: { places: { live: "below" } },
    other: { places: { live: "upper 1", wide: "below 1" } },
    second: { places: { live: "below 10" } },
    first: { places: { live: "below 2" } },
    none: {},
  };
  assert.deepEqual(placedPanels(panels, "live", "below"), ["first", "second", "last"]);
  assert.deepEqual(placedPanels(panels, "wide", "below"), ["other"]);
});

test("beside a robot that may not be run nothing is placed that runs programs", () => {
  for (const layout of /** @type {const} */ (["wide", "medium"])) {
    assert.ok(placedPanels(PANEL_FILES, layout, "below").includes("launch"));
    assert.ok(placedPanels(PANEL_FILES, layout, "below").includes("packages"));
    const kept = placedPanels(withoutRunning(PANEL_FILES), layout, "below");
    assert.ok(kept.includes("source") && !kept.includes("launch") && !kept.includes("packages"));
  }
});

test("every part of every first layout has a panel, and no two ask for the same place", () => {
  for (const layout of LAYOUTS) {
    for (const part of PARTS[layout])
      assert.ok(placedPanels(PANEL_FILES, layout, /** @type {any} */ (part)).length > 0, part);
    const places = PANEL_IDS.map((id) => PANEL_FILES[id]?.places?.[layout]).filter(Boolean);
    const numbered = places.filter((one) => one?.includes(" "));
    assert.equal(new Set(numbered).size, numbered.length, layout);
  }
});
