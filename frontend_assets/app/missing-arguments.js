/** The form of the arguments, shown by itself: the page begins without it and has it once it is needed. */

import { effect } from "vendor/preact.js";
import { role } from "../model/connection.js";
import { documentState, problems } from "../model/document.js";
import { dialog } from "../model/view.js";

/** Show the form by itself when the robot that was opened cannot be without a value. */
export function followMissing() {
  let asked = "";
  effect(() => {
    const state = documentState.value;
    const lacking = problems.value.find(({ fix }) => fix?.action === "give_arguments");
    const what = lacking && state ? `${state.id} ${lacking.sentence}` : "";
    if (what === "" || what === asked || role.value !== "presenter") return;
    asked = what;
    if (dialog.peek() === null) dialog.value = { kind: "launch", path: "" };
  });
}
