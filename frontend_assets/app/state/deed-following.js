/** Having the studio tell how deeds fare, while somebody looks. */

/** @import { FollowDeeds } from "../../types/wire.d.ts" */

import { effect } from "vendor/preact.js";
import { send } from "../wire.js";
import { connection } from "./connection.js";
import { sharedLook } from "./frames.js";

/** @type {Record<FollowDeeds["deeds"], () => () => void>} */
const FOLLOW = {
  calls: follower("calls"),
  goals: follower("goals"),
  publications: follower("publications"),
};

/** Be told of a kind of deeds; gives the end of it. @param {FollowDeeds["deeds"]} deeds */
export const followDeeds = (deeds) => FOLLOW[deeds]();

/** @param {FollowDeeds["deeds"]} deeds */
function follower(deeds) {
  return sharedLook(() => {
    const tell = (/** @type {boolean} */ following) =>
      // What is in the way is seen by the page itself: a new lane begins anew.
      void send({ type: "follow_deeds", deeds, following }).catch(() => {});
    const end = effect(() => {
      if (connection.value === "connected") tell(true);
    });
    return () => {
      end();
      tell(false);
    };
  });
}
