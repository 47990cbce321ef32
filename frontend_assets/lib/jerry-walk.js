/** Jerry's walk as this page has heard of it: his way, the commands, and whether he followed each. */

/** @import { Command, Place } from "./jerry.js" */

import { isSame, moveOf } from "./jerry.js";

/**
 * @typedef {"pending" | "followed" | "ignored" | "unknown"} Fate
 *   `ignored`: his place did not change by it; `unknown`: he is not to follow it
 * @typedef {Command & {number: number, heard_s: number, fate: Fate}} Heard
 */

const WAY_MAX = 1000;
const COMMANDS_MAX = 40;
/** He has so long to tell where a command led him. */
const PATIENCE_S = 2;

export class Walk {
  constructor() {
    /** The oldest first. @type {Place[]} */
    this.way = [];
    /** The newest first. @type {Heard[]} */
    this.commands = [];
    /** Steps that no command was heard for as yet. @type {(Place & {seen_s: number})[]} */
    this.steps = [];
    this.count = 0;
  }

  /** @returns {Place | null} null: he has not told */
  get place() {
    return this.way.at(-1) ?? null;
  }

  /** @param {Place} place that he told @param {number} now_s */
  stand({ x, y }, now_s) {
    if (!Number.isFinite(x) || !Number.isFinite(y)) return;
    const before = this.place;
    if (before && before.x === x && before.y === y) return;
    this.way.push({ x, y });
    if (this.way.length > WAY_MAX) this.way.shift();
    if (before) this.match({ x: x - before.x, y: y - before.y, seen_s: now_s });
  }

  /** @param {Place & {seen_s: number}} step */
  match(step) {
    // The oldest that fits: he takes them in turn.
    const led = this.commands.findLast((one) => one.fate === "pending" && leads(one, step));
    if (led) this.tell(led, "followed");
    else this.steps = [...this.steps.slice(1 - COMMANDS_MAX), step];
  }

  /** @param {Command} command @param {number} now_s */
  hear({ direction, steps }, now_s) {
    this.count += 1;
    const heard = { direction, steps, number: this.count, heard_s: now_s };
    this.commands = [
      { ...heard, fate: this.fateOf(heard, now_s) },
      ...this.commands.slice(0, COMMANDS_MAX - 1),
    ];
  }

  /** @param {Command} command @param {number} now_s @returns {Fate} what he told may have come before it */
  fateOf(command, now_s) {
    const move = moveOf(command);
    if (!move) return "unknown";
    if (move.x === 0 && move.y === 0) return "followed";
    const at = this.steps.findIndex(
      (step) => now_s - step.seen_s < PATIENCE_S && leads(command, step),
    );
    if (at < 0) return "pending";
    this.steps.splice(at, 1);
    return "followed";
  }

  /** @param {number} now_s @returns {boolean} whether something is given up now */
  expire(now_s) {
    const late = this.commands.filter(
      ({ fate, heard_s }) => fate === "pending" && now_s - heard_s > PATIENCE_S,
    );
    for (const one of late) this.tell(one, "ignored");
    return late.length > 0;
  }

  /** @param {Heard} command @param {Fate} fate */
  tell(command, fate) {
    this.commands = this.commands.map((one) => (one === command ? { ...one, fate } : one));
  }

  /** Forget the way that led here. */
  clear() {
    this.way = this.way.slice(-1);
    this.commands = [];
    this.steps = [];
  }
}

/** @param {Command} command @param {Place} step @returns {boolean} */
function leads(command, step) {
  const move = moveOf(command);
  return move !== null && isSame(move.x, step.x) && isSame(move.y, step.y);
}
