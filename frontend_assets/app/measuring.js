/** The measuring tool: its commands, and what the 3D view is told and tells of it. */

/** @import { Anchor } from "../lib/measuring.js" */
/** @import { Studio3d } from "./viewport.js" */

import { effect } from "vendor/preact.js";
import { centreOfMass, sumOf } from "../lib/masses.js";
import { angleText, lengthText } from "../lib/measuring.js";
import { shownNumber } from "../lib/numbers.js";
import { addCommands } from "./commands.js";
import { displays, robot } from "./state/document.js";
import { millimetres } from "./state/frame-pair.js";
import { followFrames, linkPoses } from "./state/frames.js";
import { followMasses, masses } from "./state/masses.js";
import {
  addEnd,
  measuredNow,
  measureMode,
  measuring,
  pending,
  startMeasuring,
  stepBack,
  stopMeasuring,
} from "./state/measuring.js";
import { degrees, isFree } from "./state/view.js";
import { viewport } from "./viewport.js";

export function addMeasuring() {
  addCommands([
    {
      id: "measure",
      icon: "measure",
      keys: ["M"],
      enabled: () => robot.value !== null && isFree(),
      run: () => (measuring.value ? stopMeasuring() : startMeasuring()),
    },
    {
      id: "measure_back",
      icon: "close",
      keys: ["Escape"],
      enabled: () => measuring.value && isFree(),
      run: stepBack,
    },
  ]);
  effect(() => (viewport.value ? tell(viewport.value) : undefined));
  effect(() => (showsCentre() ? followCentre() : undefined));
}

/** @param {Studio3d} view @returns {() => void} the end of it */
function tell(view) {
  const stop = new AbortController();
  view.events.addEventListener(
    "measure",
    (event) => addEnd(/** @type {CustomEvent<{anchor: Anchor}>} */ (event).detail.anchor),
    { signal: stop.signal },
  );
  const ends = [
    effect(() => view.setMeasuring(measuring.value ? measureMode.value : null)),
    effect(() => view.setMeasures([...labelled(), { ends: pending.value, label: "" }])),
    effect(() => view.setCentre(centreNow())),
  ];
  return () => {
    stop.abort();
    for (const end of ends) end();
  };
}

/** @returns {{ends: readonly Anchor[], label: string}[]} the measures as the 3D view draws them */
function labelled() {
  const units = { millimetres: millimetres.value, degrees: degrees.value };
  return measuredNow.value.flatMap(({ measure, found }) => {
    if (!found) return [];
    const { corner, distance } = found;
    const label = corner === null ? lengthText(distance, units) : angleText(corner, units);
    return [{ ends: measure.ends, label }];
  });
}

const showsCentre = () => displays.value.robot?.com === true;

/** @returns {() => void} the end of it */
function followCentre() {
  const ends = [followFrames(), followMasses()];
  return () => {
    for (const end of ends) end();
  };
}

/** @returns {{at: readonly [number, number, number], label: string} | null} the robot's centre of mass, while those of the links are shown */
function centreNow() {
  const [found, poses] = [masses.value, linkPoses.value];
  const at = showsCentre() && found && poses ? centreOfMass(found, poses) : null;
  return found && at && { at, label: `${shownNumber(sumOf(found))} kg` };
}
