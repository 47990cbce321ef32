/**
 * Sends the steps of drags one after the other: of moves that wait the newest counts, press and
 * release always go out, and while the mouse rests a word now and then says that it is still held.
 */

/** Between two moves. */
const PAUSE_MS = 33;
/** A server listens to nobody else for a second after the last word. */
const REST_MS = 250;

/**
 * @template {{action: string}} T
 * @param {(command: T) => Promise<unknown>} send its answer is null when it was refused
 * @param {(command: T) => void} refused what was under way is dropped
 * @param {(command: T) => void} released the studio has heard of the release
 */
export function createDragSender(send, refused, released) {
  /** @type {T[]} */
  let waiting = [];
  let busy = false;
  /** @type {T | null} the last step of a drag that goes on */
  let held = null;
  let said = 0;
  const resting = setInterval(() => {
    if (held && !busy && performance.now() - said >= REST_MS)
      push(/** @type {T} */ ({ ...held, action: "hold" }));
  }, REST_MS / 2);

  /** @param {T} command */
  function push(command) {
    if (waiting.at(-1)?.action === "move" && command.action !== "press") {
      // A release says where the marker is, too.
      waiting.pop();
    }
    waiting.push(command);
    held = command.action === "release" ? null : command;
    depart();
  }

  async function depart() {
    if (busy) return;
    busy = true;
    for (let next = waiting.shift(); next; next = waiting.shift()) await step(next);
    busy = false;
  }

  /** @param {T} command */
  async function step(command) {
    const answer = await send(command);
    said = performance.now();
    if (!answer) drop(command);
    else if (command.action === "release") released(command);
    if (waiting.length > 0) await new Promise((resolve) => setTimeout(resolve, PAUSE_MS));
  }

  /** Of what was refused nothing more is said. @param {T} command */
  function drop(command) {
    waiting = [];
    held = null;
    refused(command);
  }

  return { push, end: () => clearInterval(resting) };
}
