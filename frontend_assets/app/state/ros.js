/** ROS 2 as the studio last told it: the connection, and what of the robot goes out and comes in. */

/** @import { Signal } from "vendor/preact.js" */
/** @import { WireFeed, WireState } from "../../types/wire.d.ts" */

import { computed, signal } from "vendor/preact.js";
import { remembered } from "../../lib/remembered.js";
import { isPlace } from "../../lib/wire-places.js";
import { mayEdit } from "./connection.js";

/** @type {Signal<WireState>} */
export const ros = signal({
  type: "wire_state",
  state: "off",
  router: "",
  endpoint: "",
  domain: 0,
  distro: "",
  nodes: [],
  node_count: 0,
  nearby_count: 0,
  trouble: "",
});
/** @type {Signal<WireFeed>} */
export const feed = signal({
  type: "wire_feed",
  source: "sliders",
  source_state: "",
  rate_hz: 0,
  strangers: [],
  publishes_robot: false,
  publishes_joints: false,
  joints_paused: false,
  rivals: [],
  description_from: "",
  trouble: "",
});

/** Where this browser joined of late. */
export const recentPlaces = remembered(
  "ros.places",
  /** @type {readonly import("../../lib/wire-places.js").Place[]} */ ([]),
  (value) => Array.isArray(value) && value.every(isPlace),
);

/** The joints are this page's to move: nothing on the wire moves them. */
export const mayMove = computed(() => mayEdit.value && feed.value.source === "sliders");

/** @param {WireState} event */
export function takeRos(event) {
  ros.value = event;
}

/** @param {WireFeed} event */
export function takeFeed(event) {
  feed.value = event;
}
