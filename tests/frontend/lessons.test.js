import assert from "node:assert/strict";
import { test } from "node:test";
import { partsOf } from "../../frontend_assets/lib/help-text.js";
import { isSought, readLesson } from "../../frontend_assets/lib/lesson-text.js";
import { textFiles } from "../../frontend_assets/lib/text-files.js";

test("a lesson has a head, and a text in the markup of the help", () => {
  const { title, needs, blocks } = readLesson("# Two nodes\nneeds: talker listener\n\nA `text`.\n");
  assert.deepEqual([title, needs, blocks.length], ["Two nodes", ["talker", "listener"], 1]);
  const bare = readLesson("# One node\n\n[see](topics /chatter)\n");
  assert.deepEqual(bare.needs, []);
  assert.deepEqual(bare.blocks.flatMap(partsOf), [
    { kind: "link", text: "see", page: "topics", about: ["/chatter"] },
  ]);
  assert.deepEqual(readLesson("").title, "");
});

test("a lesson is found by each of its words, wherever they stand", () => {
  const talker = { demo: "talker", node: "/topic_helloworld_pub" };
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
