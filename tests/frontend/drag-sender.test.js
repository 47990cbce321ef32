import assert from "node:assert/strict";
import { test } from "node:test";
import { createDragSender } from "../../frontend_assets/lib/drag-sender.js";

/** A studio that answers when it is told to. */
function stage() {
  /** @type {{action: string, at: number, answer: (value: object | null) => void}[]} */
  const sent = [];
  /** @type {string[]} */
  const told = [];
  const sender = createDragSender(
    (/** @type {{action: string, at: number}} */ command) =>
      new Promise((resolve) => sent.push({ ...command, answer: resolve })),
    ({ action }) => void told.push(`refused ${action}`),
    ({ action }) => void told.push(`heard ${action}`),
  );
  const answerAll = async () => {
    for (let at = 0; at < 20; at += 1) {
      for (const one of sent) one.answer({});
      await new Promise((resolve) => setTimeout(resolve, 10));
    }
  };
  return { sender, sent, told, answerAll };
}

test("press and release always go out, and of moves the newest", async () => {
  const { sender, sent, told, answerAll } = stage();
  sender.push({ action: "press", at: 0 });
  for (const at of [1, 2, 3]) sender.push({ action: "move", at });
  await answerAll();
  sender.push({ action: "move", at: 4 });
  sender.push({ action: "release", at: 5 });
  await answerAll();
  sender.end();
  const steps = sent.map(({ action, at }) => `${action} ${at}`);
  assert.deepEqual(steps.slice(0, 2), ["press 0", "move 3"]);
  assert.deepEqual(steps.at(-1), "release 5");
  assert.deepEqual(told, ["heard release"]);
});

test("of what was refused nothing more goes out", async () => {
  const { sender, sent, told } = stage();
  sender.push({ action: "press", at: 0 });
  sender.push({ action: "move", at: 1 });
  sent[0]?.answer(null);
  await new Promise((resolve) => setTimeout(resolve, 60));
  sender.end();
  assert.equal(sent.length, 1);
  assert.deepEqual(told, ["refused press"]);
});

test("while the mouse rests, a word now and then says that the marker is held", async () => {
  const { sender, sent, answerAll } = stage();
  sender.push({ action: "press", at: 0 });
  await answerAll();
  await answerAll();
  sender.end();
  assert.equal(sent.at(-1)?.action, "hold");
});
