import assert from "node:assert/strict";
import { test } from "node:test";
import { hostOf, isDomain, isPlace, withRecent } from "../../frontend_assets/model/ros.js";

/** @param {string} address @returns {import("../../frontend_assets/model/ros.js").Place} */
const place = (address) => ({ address, domain: 0, distro: "jazzy" });

test("the place that was joined last comes first, and each is kept once", () => {
  let places = ["a", "b", "a"].reduce(
    (all, one) => withRecent(all, place(one)),
    /** @type {import("../../frontend_assets/model/ros.js").Place[]} */ ([]),
  );
  assert.deepEqual(
    places.map(({ address }) => address),
    ["a", "b"],
  );
  for (let n = 0; n < 20; n += 1) places = withRecent(places, place(`host-${n}`));
  assert.equal(places.length, 6);
});

test("what an older page stored, or somebody wrote, is no place", () => {
  assert.ok(isPlace(place("tcp/a:1")));
  for (const bad of [null, 3, {}, { address: "a" }, { ...place("a"), domain: 500 }, "a"])
    assert.ok(!isPlace(bad));
  assert.ok(!isDomain(Number.NaN) && !isDomain(1.5) && isDomain(232));
});

test("the machine of an endpoint is named unless it is this one", () => {
  assert.equal(hostOf("tcp/robot.local:7447"), "robot.local");
  assert.equal(hostOf("tls/[fe80::1]:7447?x=1"), "[fe80::1]");
  for (const own of ["tcp/127.0.0.1:7447", "tcp/localhost:1", "tcp/[::1]:7447", ""])
    assert.equal(hostOf(own), "");
});
