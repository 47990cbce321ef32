import assert from "node:assert/strict";
import { test } from "node:test";
import { inPieces, siblingPlaces } from "../../frontend_assets/lib/long-list.js";

test("a thousand rows are drawn in pieces, none twice and none missing", () => {
  const ids = Array.from({ length: 1000 }, (_, n) => String(n));
  const pieces = inPieces(ids);
  assert.ok(pieces.every((piece) => piece.length > 0 && piece.length <= 24));
  assert.deepEqual(pieces.flat(), ids);
});

test("rows of a tree are counted among their siblings, not among those of another parent", () => {
  const places = siblingPlaces([1, 2, 3, 3, 2, 3, 1]);
  assert.deepEqual(
    places.map(({ at, of }) => `${at}/${of}`),
    ["1/2", "1/2", "1/2", "2/2", "2/2", "1/1", "2/2"],
  );
});
