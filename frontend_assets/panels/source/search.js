/** Words in all files of the robot: where they stand, and other words in their place. */

/** @import { FoundText, TextsFound } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, useEffect, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { addCommands, commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { allSettled } from "../../lib/latest.js";
import { shortPath } from "../../lib/paths.js";
import { Icon, IconButton } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { documentState, history } from "../../model/document.js";
import { ask } from "../../model/requests.js";
import { filesSearch, showSource } from "../../model/source.js";
import { notify } from "../../model/view.js";
import { send } from "../../model/wire.js";

const REST_MS = 180;

addCommands([
  {
    id: "find_in_files",
    icon: "search",
    keys: ["Mod+Shift+F"],
    inText: true,
    run: findInFiles,
    enabled: () => documentState.value !== null,
  },
]);

/** Brings the search to the front, for what is selected in the text. @returns {true} */
export function findInFiles() {
  const picked = String(getSelection() ?? "").trim();
  const before = filesSearch.peek();
  const text = picked.includes("\n") ? "" : picked;
  filesSearch.value = { text: text || (before?.text ?? ""), turn: (before?.turn ?? 0) + 1 };
  commandById("panel.source")?.run();
  return true;
}

/** @returns {import("vendor/preact.js").VNode | null} */
export function SourceSearch() {
  const wanted = filesSearch.value;
  return wanted ? html`<${Search} wanted=${wanted} />` : null;
}

/** @param {{wanted: {text: string, turn: number}}} props */
function Search({ wanted }) {
  const words = useSignal(wanted.text);
  const replacement = useSignal("");
  const matchCase = useSignal(false);
  const wholeWord = useSignal(false);
  const found = useSignal(/** @type {TextsFound | null} */ (null));
  const field = useRef(/** @type {HTMLInputElement | null} */ (null));
  // At once: what is typed next stands in the field.
  useLayoutEffect(() => {
    words.value = wanted.text;
    field.current?.focus();
    field.current?.select();
  }, [wanted]);
  const query = { text: words.value, match_case: matchCase.value, whole_word: wholeWord.value };
  useFound(query, found);
  const close = () => {
    filesSearch.value = null;
  };
  return html`<form class="files-search" aria-label=${t("search.title")} onSubmit=${(/** @type {Event} */ event) => event.preventDefault()}
    onKeyDown=${(/** @type {KeyboardEvent} */ event) => onKey(event, close)}>
    <div class="files-search-line">
      <input ref=${field} type="search" spellcheck=${false} placeholder=${t("search.find")} aria-label=${t("search.find")}
        value=${words.value} onInput=${into(words)} />
      <${Toggle} label=${t("search.case")} sign="Aa" on=${matchCase} />
      <${Toggle} label=${t("search.words")} sign="W" on=${wholeWord} />
      <span class="muted numbers files-search-count" role="status">${countWords(found.value)}</span>
      <span class="push"></span>
      <${IconButton} icon="close" size=${14} label=${t("search.close")} onClick=${close} />
    </div>
    ${mayEdit.value && html`<${Replace} query=${query} found=${found} replacement=${replacement} />`}
    <${Results} found=${found.value} />
  </form>`;
}

/** @param {Signal<string>} signal @returns {(event: any) => void} */
const into = (signal) => (event) => {
  signal.value = event.currentTarget.value;
};

/** @param {KeyboardEvent} event arrows walk over what was found @param {() => void} close */
function onKey(event, close) {
  if (event.key === "Escape") {
    event.stopPropagation();
    close();
    return;
  }
  const form = /** @type {HTMLElement} */ (event.currentTarget);
  const all = /** @type {HTMLElement[]} */ ([...form.querySelectorAll(".files-search-hit")]);
  const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
  const step = event.key === "ArrowDown" ? 1 : -1;
  const isMove = event.key === "ArrowDown" || (event.key === "ArrowUp" && at >= 0);
  const isFirst = event.key === "Enter" && document.activeElement === form.querySelector("input");
  if (isFirst) all[0]?.click();
  else if (isMove) all[Math.max(at + step, 0)]?.focus();
  else return;
  event.preventDefault();
}

/** @param {{label: string, sign: string, on: Signal<boolean>}} props */
function Toggle({ label, sign, on }) {
  const toggle = () => {
    on.value = !on.value;
  };
  return html`<button type="button" class="icon-button sign" aria-label=${label} title=${label}
    aria-pressed=${on.value} onClick=${toggle}>${sign}</button>`;
}

/** Looks again as words, and the texts themselves, change. @param {{text: string, match_case: boolean, whole_word: boolean}} query @param {Signal<TextsFound | null>} found */
function useFound(query, found) {
  const texts = history.value;
  useEffect(() => {
    if (query.text === "") {
      found.value = null;
      return undefined;
    }
    let isOld = false;
    const later = setTimeout(async () => {
      await allSettled();
      const answer = await send({ type: "find_texts", ...query }).catch(() => null);
      if (!isOld && answer?.type === "texts_found") found.value = answer;
    }, REST_MS);
    return () => {
      isOld = true;
      clearTimeout(later);
    };
  }, [query.text, query.match_case, query.whole_word, texts]);
}

/** @param {TextsFound | null} found @returns {string} */
function countWords(found) {
  if (!found) return "";
  if (found.count === 0) return t("search.none");
  return t("search.count", {
    count: found.count,
    files: t("rename.files", { count: found.files }),
  });
}

/** @param {{query: {text: string, match_case: boolean, whole_word: boolean}, found: Signal<TextsFound | null>, replacement: Signal<string>}} props */
function Replace({ query, found, replacement }) {
  const count = found.value?.count ?? 0;
  const replace = async () => {
    await allSettled();
    const command = { ...query, replacement: replacement.value, count };
    if (await ask({ type: "replace_texts", ...command })) notify(t("search.replaced", { count }));
  };
  return html`<div class="files-search-line">
    <input type="text" spellcheck=${false} placeholder=${t("search.replace")} aria-label=${t("search.replace")}
      value=${replacement.value} onInput=${into(replacement)} />
    <button type="button" class="button small" disabled=${count === 0} onClick=${replace}>${t("search.replace_all", { count })}</button>
  </div>`;
}

/** @param {{found: TextsFound | null}} props */
function Results({ found }) {
  if (!found || found.count === 0) return null;
  const root = documentState.value?.root ?? "";
  /** @type {Map<string, FoundText[]>} */
  const files = new Map();
  for (const one of found.places)
    files.set(one.place.file, [...(files.get(one.place.file) ?? []), one]);
  return html`<div class="files-search-results scroll">
    ${[...files].map(
      ([file, places]) => html`<section key=${file}>
        <h3 title=${file}><${Icon} name="fileCode" size=${13} />${shortPath(file, root)} <span class="numbers">${places.length}</span></h3>
        ${places.map((one) => html`<${Hit} key=${`${one.place.line}:${one.place.column}`} found=${one} />`)}
      </section>`,
    )}
    ${found.count > found.places.length && html`<p class="muted">${t("search.more", { count: found.places.length })}</p>`}
  </div>`;
}

/** @param {{found: FoundText}} props a line with what was found in it marked */
function Hit({ found: { place, line, line_column: from } }) {
  const start = place.column - from;
  const end = start + place.length;
  return html`<button type="button" class="files-search-hit" onClick=${() => showSource(place.file, place.line, place.column)}>
    <span class="numbers">${place.line}</span>
    <code>${line.slice(0, start)}<mark>${line.slice(start, end)}</mark>${line.slice(end)}</code></button>`;
}
