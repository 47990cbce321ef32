/**
 * Asking the studio for what a panel shows: once, again and again while the panel is seen, or
 * after each build. Why it refused is kept for the panel to show.
 */

/** @import { Changed, Command } from "../types/wire.d.ts" */
/** @import { Answer, Asked } from "./wire.js" */
/** @import { Signal } from "vendor/preact.js" */

import { effect, signal, untracked, useEffect, useRef, useSignal } from "vendor/preact.js";
import { useSeen } from "../lib/seen.js";
import { connection } from "./connection.js";
import { built, robot } from "./document.js";
import { RefusedError, send, subscribe } from "./wire.js";

/**
 * Ask; a refusal is kept until the next answer. When the lane is lost, nothing is said: whoever looks
 * asks again with the next one.
 *
 * @param {Asked<Command>} command
 * @param {Signal<string>} refused is given the studio's sentence; empty when it answered
 * @returns {Promise<Answer | null>}
 */
export async function askOrKeepWhy(command, refused) {
  try {
    const answer = await send(command);
    refused.value = "";
    return answer;
  } catch (error) {
    if (error instanceof RefusedError) refused.value = error.message;
    return null;
  }
}

/**
 * @param {() => Promise<boolean | void>} ask gives whether there is more to be asked for at once
 * @param {number} everyMs from an answer to the next question
 * @returns {() => void} the end of it
 */
export function keepAsking(ask, everyMs) {
  let over = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const look = async () => {
    const more = await ask();
    if (!over) timer = setTimeout(look, more ? 0 : everyMs);
  };
  look();
  return () => {
    over = true;
    clearTimeout(timer);
  };
}

/**
 * Ask at once and whenever something was built: never twice at a time, and once more when more was
 * built meanwhile.
 *
 * @param {() => Promise<void>} ask
 * @param {number} [restMs] between two, for what costs the studio more
 * @returns {() => void} the end of it
 */
export function askWhenBuilt(ask, restMs = 0) {
  let asking = false;
  let again = false;
  let over = false;
  const go = async () => {
    asking = true;
    do {
      again = false;
      await untracked(ask);
      if (restMs > 0) await new Promise((resolve) => setTimeout(resolve, restMs));
    } while (again && !over);
    asking = false;
  };
  const end = effect(() => {
    built.value;
    if (connection.value !== "connected" || robot.value === null) return;
    if (asking) again = true;
    else go();
  });
  return () => {
    over = true;
    end();
  };
}

/**
 * However many look, one asks.
 *
 * @param {() => () => void} begin to ask; gives the end of it
 * @returns {() => () => void} begin to look; gives the end of looking
 */
export function sharedFollowing(begin) {
  let lookers = 0;
  /** @type {() => void} */
  let stop = () => {};
  return () => {
    lookers += 1;
    if (lookers === 1) stop = begin();
    let over = false;
    return () => {
      if (over) return;
      over = true;
      lookers -= 1;
      if (lookers === 0) stop();
    };
  };
}

/**
 * @param {() => Promise<boolean | void>} ask gives whether there is more to be asked for at once
 * @param {number} everyMs from an answer to the next question
 * @param {() => boolean} [isOn] whether there is anything to ask; when what it reads changes, it is asked at once
 * @returns {() => () => void} begin to look; gives the end of looking
 */
export const polled = (ask, everyMs, isOn = () => true) =>
  sharedFollowing(() => {
    let end = () => {};
    const forget = effect(() => {
      end();
      end = () => {};
      if (!isOn() || connection.value !== "connected") return;
      untracked(() => {
        end = keepAsking(async () => !document.hidden && (await ask()), everyMs);
      });
    });
    return () => {
      forget();
      end();
    };
  });

/** How often each was told to have changed. @type {Record<Changed["subject"], Signal<number>>} */
const changes = {
  graph: signal(0),
  log: signal(0),
  diagnostics: signal(0),
  goal_statuses: signal(0),
  lessons: signal(0),
  lesson_list: signal(0),
  ticks: signal(0),
  workspaces: signal(0),
  runs: signal(0),
};

subscribe("changed", ({ subject }) => {
  changes[subject].value += 1;
});

/** @param {Changed["subject"]} subject @returns {number} how often it was told to have changed */
export const changeCount = (subject) => changes[subject].peek();

/** @param {Changed["subject"]} subject be told of its changes; gives the end of it */
const followChanges = (subject) =>
  sharedFollowing(() => {
    const tell = (/** @type {boolean} */ following) =>
      // What is in the way is seen by the page itself: a new lane begins anew.
      void send({ type: "follow_changes", subject, following }).catch(() => {});
    const end = effect(() => {
      if (connection.value === "connected") tell(true);
    });
    return () => {
      end();
      tell(false);
    };
  });
const FOLLOW = {
  graph: followChanges("graph"),
  log: followChanges("log"),
  diagnostics: followChanges("diagnostics"),
  goal_statuses: followChanges("goal_statuses"),
  lessons: followChanges("lessons"),
  lesson_list: followChanges("lesson_list"),
  ticks: followChanges("ticks"),
  workspaces: followChanges("workspaces"),
  runs: followChanges("runs"),
};

/** @param {() => Promise<boolean | void>} ask gives whether there is more @returns {() => Promise<void>} asks; while that goes on, once more afterwards */
function oneAtATime(ask) {
  let asking = false;
  let again = false;
  return async () => {
    again = true;
    if (asking) return;
    asking = true;
    try {
      while (again) {
        again = false;
        if (await ask()) again = true;
      }
    } finally {
      asking = false;
    }
  };
}

/**
 * Ask at once and whenever the studio says that something changed, never twice at a time; a page
 * that is not seen asks once it is.
 *
 * @param {() => Promise<boolean | void>} ask gives whether there is more to be asked for at once
 * @param {Changed["subject"][]} subjects what it is asked about
 * @returns {() => () => void} begin to look; gives the end of looking
 */
export const askedWhenChanged = (ask, ...subjects) =>
  sharedFollowing(() => {
    let over = false;
    const go = oneAtATime(async () => !over && !document.hidden && (await ask()));
    const unfollow = subjects.map((subject) => FOLLOW[subject]());
    const forget = effect(() => {
      for (const subject of subjects) changes[subject].value;
      if (connection.value === "connected") untracked(() => void go());
    });
    document.addEventListener("visibilitychange", go);
    return () => {
      over = true;
      document.removeEventListener("visibilitychange", go);
      forget();
      for (const end of unfollow) end();
    };
  });

/**
 * @param {() => () => void} follow begin to ask; gives the end of asking
 * @returns {{panel: {current: HTMLElement | null}, looking: boolean}} `panel` is to be set as its `ref`
 */
export function useLooking(follow) {
  const panel = useRef(/** @type {HTMLElement | null} */ (null));
  const seen = useSignal(false);
  useSeen(panel, (is) => {
    seen.value = is;
  });
  const looking = seen.value;
  useEffect(() => (looking ? follow() : undefined), [looking]);
  return { panel, looking };
}

/**
 * What the studio tells, kept up to date while the component stands.
 *
 * @template T
 * @param {T} first until it is told, and anew when what it is asked of changes
 * @param {() => Promise<T | null>} ask null: the studio does not answer
 * @param {(ask: () => Promise<void>) => () => () => void} asking when it is asked, as `polled` or `askedWhenChanged` make it
 * @param {readonly unknown[]} [of] what it is asked of
 * @returns {Signal<T>}
 */
export function useTold(first, ask, asking, of = []) {
  const reply = useSignal(first);
  useEffect(() => {
    reply.value = first;
    let over = false;
    const end = asking(async () => {
      const answer = await ask();
      if (answer !== null && !over) reply.value = answer;
    })();
    return () => {
      over = true;
      end();
    };
  }, of);
  return reply;
}
