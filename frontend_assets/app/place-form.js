/** Where something new goes: a folder of those that may be written, and a name for a package. */

/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useId, useSignal } from "vendor/preact.js";
import { t } from "../lib/i18n.js";
import { Icon } from "../lib/ui.js";
import { ask } from "../model/requests.js";

/** @typedef {{name: Signal<string>, folder: Signal<string>, folders: Signal<readonly string[]>}} Place */

/** @param {string} name to begin with @returns {Place} */
export function usePlace(name) {
  const place = {
    name: useSignal(name),
    folder: useSignal(""),
    folders: useSignal(/** @type {readonly string[]} */ ([])),
  };
  useEffect(() => {
    ask({ type: "list_places" }).then((answer) => {
      if (answer?.type !== "places") return;
      place.folders.value = answer.folders;
      place.folder.value = answer.folders[0] ?? "";
    });
  }, []);
  return place;
}

/** @param {{place: Place, path: string}} props `path`: what will be made, below the folder */
export function PlaceFields({ place, path }) {
  const hint = useId();
  const fault = nameFault(place.name.value);
  const options = useId();
  return html`<div class="place-fields">
    <label class="form-row"><span>${t("new.name")}</span>
      <input type="text" class="box wide" data-first value=${place.name.value} spellcheck=${false} autocomplete="off" maxlength=${80}
        aria-invalid=${fault !== ""} aria-describedby=${hint} onInput=${(
          /** @type {any} */ event,
        ) => {
          place.name.value = event.currentTarget.value;
        }} /></label>
    <p id=${hint} class=${`form-hint ${fault ? "bad" : ""}`} role="status"><${Icon} name=${fault ? "alert" : "check"} size=${14} /><span>${t(fault || "name.good")}</span></p>
    <label class="form-row"><span>${t("new.folder")}</span>
      <input type="text" class="box wide" list=${options} value=${place.folder.value} spellcheck=${false} onInput=${(
        /** @type {any} */ event,
      ) => {
        place.folder.value = event.currentTarget.value;
      }} /></label>
    <datalist id=${options}>${place.folders.value.map((folder) => html`<option key=${folder} value=${folder}></option>`)}</datalist>
    <p class="form-hint"><${Icon} name="filePlus" size=${14} /><span class="form-path">${place.folder.value.replace(/[/\\]+$/, "")}/${path}</span></p>
  </div>`;
}

const LENGTH_LIMIT = 60;
const ENDING = "_description";

/** @type {readonly [RegExp, string][]} what is wrong with a name, most telling first */
const FAULTS = [
  [/^.?$/, "name.short"],
  [new RegExp(`^.{${LENGTH_LIMIT + 1},}$`), "name.long"],
  [/[A-Z]/, "name.capital"],
  [/[\s-]/, "name.blank"],
  [/[^a-z0-9_]/, "name.sign"],
  [/^[^a-z]/, "name.first"],
  [/__/, "name.double"],
  [/_$/, "name.last"],
];

/** @param {string} name @returns {string} key of a sentence; empty when nothing is wrong */
export function nameFault(name) {
  return FAULTS.find(([pattern]) => pattern.test(name))?.[1] ?? "";
}

/** @param {string} name of a package @returns {string} the robot that it describes */
export function robotOf(name) {
  const short = name.endsWith(ENDING) ? name.slice(0, -ENDING.length) : name;
  return short || name;
}
