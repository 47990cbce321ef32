import assert from "node:assert/strict";
import { test } from "node:test";
import { partsOf, textFiles } from "../../frontend_assets/lib/help-text.js";
import {
  isSought,
  NOTHING_PRINTED,
  readLesson,
  withPrinted,
} from "../../frontend_assets/model/lessons.js";

test("a lesson has a head, and a text in the markup of the help", () => {
  const { title, needs, blocks } = readLesson("# Two nodes\nneeds: talker listener\n\nA `text`.\n");
  assert.deepEqual([title, needs, blocks.length], ["Two nodes", ["talker", "listener"], 1]);
  const bare = readLesson("# One node\n\n[see](topics /chatter)\n");
  assert.deepEqual(bare.needs, []);
  assert.deepEqual(
    bare.blocks.flatMap((block) => (block.kind === "checks" ? [] : partsOf(block))),
    [{ kind: "link", text: "see", page: "topics", about: ["/chatter"] }],
  );
  assert.deepEqual(readLesson("").title, "");
});

test("lines of checks are a step where they stand, numbered through the lesson", () => {
  const { blocks } = readLesson(
    "# T\n\nText,\ncheck: no errors\n  check: node /a runs\ngoes on.\n\n## Try\n\ncheck: opened graph\n",
  );
  assert.deepEqual(
    blocks.map((block) => (block.kind === "checks" ? [block.step, ...block.lines] : block.kind)),
    ["text", [0, "no errors", "node /a runs"], "text", "heading", [1, "opened graph"]],
  );
});

test("a lesson is found by each of its words, wherever they stand", () => {
  const talker = { name: "talker", node: "/topic_helloworld_pub" };
  assert.ok(isSought("", talker, ""));
  assert.ok(isSought("Publisher helloworld", talker, "This publisher talks."));
  assert.ok(!isSought("publisher service", talker, "This publisher talks."));
});

test("a text that could not be had is fetched again, and one that came is kept", async () => {
  const answers = [new Response("", { status: 404 }), new Response("here")];
  /** @type {string[]} */
  const asked = [];
  const real = globalThis.fetch;
  globalThis.fetch = async (address) => {
    asked.push(String(address));
    return answers.shift() ?? Response.error();
  };
  try {
    const known = textFiles("/texts/", (text) => text.length);
    assert.deepEqual([await known("a.md"), await known("a.md"), await known("a.md")], [0, 4, 4]);
    assert.deepEqual(asked, ["/texts/a.md", "/texts/a.md"]);
  } finally {
    globalThis.fetch = real;
  }
});

test("what a demo printed grows by what is told, up to a bound, and begins anew with a run", () => {
  const first = withPrinted(NOTHING_PRINTED, { run: 1, lines: ["a", "b"], last: 2 });
  const grown = withPrinted(first, { run: 1, lines: ["c"], last: 3 });
  assert.deepEqual(grown, { run: 1, lines: ["a", "b", "c"], last: 3 });
  assert.equal(withPrinted(grown, { run: 1, lines: [], last: 3 }), grown);
  const many = Array.from({ length: 199 }, (_, at) => String(at));
  const full = withPrinted(grown, { run: 1, lines: many, last: 202 });
  assert.deepEqual([full.lines.length, full.lines[0], full.lines.at(-1)], [200, "c", "198"]);
  assert.deepEqual(withPrinted(full, { run: 2, lines: [], last: 0 }).lines, []);
});
