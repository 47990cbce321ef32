import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";

const HERE = "http://here.example:8100/room";
const OTHERS = [
  "http://one.example:8100/room/join?pass=abc",
  "http://two.example/room/join?pass=abc",
];
const HEALTH = ["http://one.example:8100/room/health", "http://two.example/room/health"];

/** What the page has of the browser. */
class FakeSocket {
  static OPEN = 1;
  /** @type {FakeSocket[]} */
  static opened = [];
  readyState = 1;
  onclose = () => {};
  onmessage = (/** @type {{data: string}} */ _) => {};
  constructor() {
    FakeSocket.opened.push(this);
  }
  close() {}
}
class FakeWorker {
  static running = 0;
  /** @type {string[]} */
  static there = [];
  /** @type {string[]} */
  static asked = [];
  onmessage = (/** @type {{data: string | null}} */ _) => {};
  constructor() {
    FakeWorker.running += 1;
  }
  terminate() {
    FakeWorker.running -= 1;
  }
  /** @param {string[]} urls */
  postMessage(urls) {
    FakeWorker.asked = urls;
    const data = urls.find((one) => FakeWorker.there.includes(one)) ?? null;
    queueMicrotask(() => this.onmessage({ data }));
  }
}
/** @type {string[]} */
let gone = [];
let ownIsThere = false;
let ownStatus = 200;
const BROWSER = {
  WebSocket: FakeSocket,
  Worker: FakeWorker,
  addEventListener() {},
  location: { href: `${HERE}/d/arm`, assign: (/** @type {string} */ to) => gone.push(to) },
  document: { hidden: false, documentElement: { dataset: { root: "/room" } } },
  fetch: async () => ({ ok: ownIsThere, status: ownStatus }),
};
for (const [name, value] of Object.entries(BROWSER))
  Object.defineProperty(globalThis, name, { value, configurable: true });

const { connection, documentId, turnedAway } = await import(
  "../../frontend_assets/model/connection.js"
);
const { healthOf, movesOn, studioAway, wayTo } = await import(
  "../../frontend_assets/model/relays.js"
);
const { connect } = await import("../../frontend_assets/model/wire.js");
const { fullView } = await import("../../frontend_assets/model/view.js");

mock.timers.enable({ apis: ["setTimeout", "setInterval"] });
let now_ms = 0;
mock.method(performance, "now", () => now_ms);
connect(() => {});

const socket = () => /** @type {FakeSocket} */ (FakeSocket.opened.at(-1));
/** @param {object} event */
const say = (event) => socket().onmessage({ data: JSON.stringify(event) });
function greet() {
  say({ type: "hello", role: "student", version: "1", session: "s" });
}
/** @param {string} studio @param {string[]} others */
const tell = (studio, others) => say({ type: "relay_state", studio, others });
/** Every attempt to come back fails. @param {number} ms */
async function offline(ms) {
  for (let passed = 0; passed < ms; passed += 50) {
    mock.timers.tick(50);
    now_ms += 50;
    const before = socket();
    if (connection.value === "lost" && before.readyState === 1) {
      before.readyState = 3;
      before.onclose();
    }
    for (let turn = 0; turn < 20; turn += 1) await null;
  }
}
/** Nothing comes, and no socket closes. @param {number} ms */
async function quiet(ms) {
  for (let passed = 0; passed < ms; passed += 1000) {
    mock.timers.tick(1000);
    now_ms += 1000;
    for (let turn = 0; turn < 20; turn += 1) await null;
  }
}
function lose() {
  socket().readyState = 3;
  socket().onclose();
}

beforeEach(() => {
  if (connection.value === "lost") mock.timers.tick(5000);
  gone = [];
  ownIsThere = false;
  ownStatus = 200;
  FakeWorker.there = [...HEALTH];
  FakeWorker.asked = [];
  documentId.value = "arm";
  fullView.value = false;
  greet();
  tell("there", OTHERS);
});

test("what is probed of another relay has no pass in it", () => {
  assert.deepEqual(OTHERS.map(healthOf), HEALTH);
});

test("the way to another relay keeps the pass, the document and the full screen", () => {
  const way = new URL(wayTo(String(OTHERS[0]), "arm~p 1&x", true));
  assert.equal(way.origin + way.pathname, "http://one.example:8100/room/join");
  assert.deepEqual(Object.fromEntries(way.searchParams), {
    ...{ pass: "abc", next: "/d/arm~p 1&x", fullscreen: "1" },
  });
  assert.equal(wayTo(String(OTHERS[0]), "", false), OTHERS[0]);
});

test("while the studio is away it is said, and no more once it is there", () => {
  tell("away", OTHERS);
  assert.equal(studioAway.value, true);
  tell("there", OTHERS);
  assert.equal(studioAway.value, false);
});

test("a relay that is only started anew keeps its people", async () => {
  lose();
  await offline(1900);
  assert.deepEqual(FakeWorker.asked, []);
  greet();
  await offline(10_000);
  assert.deepEqual([gone, movesOn.value], [[], false]);
});

test("once a relay is gone the page says so, and then goes on at another that is there", async () => {
  FakeWorker.there = HEALTH.slice(1);
  fullView.value = true;
  lose();
  await offline(2100);
  assert.deepEqual([...FakeWorker.asked].sort(), HEALTH);
  assert.deepEqual([gone, movesOn.value], [[], true], "it is read before the page goes");
  await offline(1500);
  assert.deepEqual(gone, [`${OTHERS[1]}&next=%2Fd%2Farm&fullscreen=1`]);
  await offline(10_000);
  assert.equal(gone.length, 1);
});

test("who comes back while it is said stays", async () => {
  lose();
  await offline(2100);
  assert.equal(movesOn.value, true);
  greet();
  await offline(5000);
  assert.deepEqual([gone, movesOn.value], [[], false]);
});

test("while nobody is there it goes on trying, and asks again", async () => {
  FakeWorker.there = [];
  lose();
  await offline(4000);
  assert.deepEqual([gone, movesOn.value], [[], false]);
  FakeWorker.there = HEALTH.slice(0, 1);
  await offline(5000);
  assert.equal(gone.length, 1);
});

test("nobody leaves a relay that answers, nor one that turned them away", async () => {
  ownIsThere = true;
  lose();
  await offline(6000);
  assert.deepEqual(gone, []);
  ownIsThere = false;
  ownStatus = 403;
  turnedAway.value = true;
  await offline(6000);
  assert.deepEqual(gone, []);
});

test("a relay that is gone without a word is found gone after a silence", async () => {
  await quiet(20_000);
  const given = socket();
  await quiet(20_000);
  assert.notEqual(socket(), given);
  assert.equal(connection.value, "lost");
  await offline(4000);
  assert.equal(gone.length, 1);
  given.onclose();
  assert.equal(gone.length, 1, "its socket, which closes late, counts no more");
});

test("a relay that only has nothing to say keeps its people", async () => {
  ownIsThere = true;
  await quiet(60_000);
  assert.equal(connection.value, "connected");
});

test("with no other relay nothing is probed", async () => {
  tell("there", []);
  assert.equal(FakeWorker.running, 0);
  lose();
  await offline(6000);
  assert.deepEqual([gone, FakeWorker.asked], [[], []]);
});

test("the probe begins anew when there are other relays, not when only the passes are others", () => {
  const before = FakeWorker.running;
  tell(
    "there",
    OTHERS.map((one) => one.replace("abc", "def")),
  );
  tell("there", [...OTHERS, "http://three.example/room/join?pass=abc"]);
  assert.deepEqual([before, FakeWorker.running], [1, 1]);
});

test("people spread over the relays that are there", async () => {
  const first = new Set();
  while (first.size < HEALTH.length) {
    greet();
    lose();
    await offline(2100);
    first.add(FakeWorker.asked[0]);
  }
  assert.deepEqual([...first].sort(), HEALTH);
});
