/** The source texts, read and written: a tab per file, an editor, and what is wrong at its very place. */

/** @import { Problem } from "../../types/wire.d.ts" */

import {
  EditorState,
  EditorView,
  foldAll,
  gotoLine,
  openSearchPanel,
  setDiagnostics,
  unfoldAll,
} from "vendor/codemirror.js";
import { html, useEffect, useMemo, useRef } from "vendor/preact.js";
import { language, t } from "../../lib/i18n.js";
import { baseName } from "../../lib/paths.js";
import { recall, remember } from "../../lib/remembered.js";
import { EmptyState, Icon, ProgressBar } from "../../lib/ui.js";
import { connection, mayEdit } from "../../model/connection.js";
import { documentState, history, problems } from "../../model/document.js";
import { canMend, mend } from "../../model/requests.js";
import {
  cursorPlace,
  litPlaces,
  openFile,
  openFiles,
  shownFile,
  wantedPlace,
} from "../../model/source.js";
import { theme } from "../../model/view.js";
import { setSaved } from "./changes.js";
import { adjust, goToPlace, setLit } from "./editor.js";
import { SourceSearch } from "./search.js";
import { useSelection } from "./selection.js";
import { SourceTabs } from "./tabs.js";
import { SourceTexts } from "./texts.js";

export function SourcePanel() {
  useRememberedFiles();
  const host = useRef(/** @type {HTMLElement | null} */ (null));
  const texts = useMemo(() => new SourceTexts(), []);
  useEditor(texts, host);
  const file = shownFile.value;
  const shown = texts.shown.value;
  const onView = (/** @type {(view: EditorView) => void} */ run) => () => {
    if (texts.view) run(texts.view);
  };
  return html`<section class="panel-body source" aria-label=${t("panel.source")}>
    <${SourceTabs} find=${onView(openSearchPanel)} goToLine=${onView(gotoLine)} fold=${onView(foldAll)} unfold=${onView(unfoldAll)}>
      ${shown?.link && html`<${Place} />`}
    <//>
    <${SourceSearch} />
    ${shown?.link?.readOnly && html`<p class="source-note"><${Icon} name="lock" size=${13} />${shown.link.readOnly}</p>`}
    <div class="source-editor" ref=${host} hidden=${!shown?.link} role="tabpanel" aria-label=${baseName(file)}></div>
    ${!shown?.link && html`<${Waiting} file=${file} reason=${shown?.reason ?? ""} />`}
  </section>`;
}

/** @param {{file: string, reason: string}} props what stands where no text is shown yet */
function Waiting({ file, reason }) {
  if (file === "") {
    const entry = documentState.value?.is_bare ? "" : documentState.value?.path;
    return html`<${EmptyState} icon="source" title=${t("source.none")}>
      ${!entry && html`<p>${t("source.none.packages")}</p>`}
      ${entry && html`<button type="button" class="button" onClick=${() => openFile(entry)}>${t("source.open_entry")}</button>`}<//>`;
  }
  if (reason) return html`<${EmptyState} icon="alert" title=${reason} />`;
  return html`<${ProgressBar} label=${t("loading")} done=${0} total=${0} />`;
}

/** Where in the file one is: beside its name, since a line of its own would be a line of the text less. */
function Place() {
  const place = cursorPlace.value;
  return html`<div class="source-place">
    ${!mayEdit.value && html`<span title=${t("source.look_only")}><${Icon} name="lock" size=${12} /><span class="hidden-words">${t("source.look_only")}</span></span>`}
    ${place && html`<span class="numbers">${t("source.place", { line: place.line, column: place.column })}</span>`}
  </div>`;
}

/** @param {string} path of the entry file @returns {string[]} the file in front, then all tabs */
function filesOfLastVisit(path) {
  const stored = recall(`source.${path}`);
  const files = Array.isArray(stored) ? stored.filter((one) => typeof one === "string") : [];
  if (files.length > 0) return files.length > 1 ? files : [...files, path];
  // A folder without a robot has no text that is meant before another.
  return documentState.value?.is_bare ? [] : [path, path];
}

/** The tabs of this document are those of the last visit; at the first, the entry file. */
function useRememberedFiles() {
  const path = documentState.value?.path ?? "";
  useEffect(() => {
    if (path === "" || openFiles.value.length > 0) return;
    const [shown, ...tabs] = filesOfLastVisit(path);
    for (const file of tabs) openFile(file);
    if (shown) openFile(shown);
  }, [path]);
  const files = openFiles.value;
  const shown = shownFile.value;
  useEffect(() => {
    if (path !== "" && files.length > 0) remember(`source.${path}`, [shown, ...files]);
  }, [path, files, shown]);
}

/** @param {SourceTexts} texts @param {{current: HTMLElement | null}} host */
function useEditor(texts, host) {
  useEffect(() => {
    if (!host.current) return undefined;
    const view = new EditorView({ state: EditorState.create({}), parent: host.current });
    texts.begin(view);
    return () => texts.end();
  }, []);
  const file = shownFile.value;
  const files = openFiles.value;
  const there = connection.value === "connected";
  // Again when the studio is back: a text that was not to be had then may be now.
  useEffect(() => texts.show(file), [file, there]);
  useEffect(() => texts.keepOnly(files), [files]);
  useWords(texts);
  useMarks(texts);
  useSaved(texts);
  useLights(texts);
  useSelection(texts);
  useWanted(texts);
}

/** @param {SourceTexts} texts */
function useWords(texts) {
  const link = texts.shown.value?.link;
  const dark = theme.value === "dark";
  const words = language.value;
  const free = mayEdit.value;
  useEffect(() => {
    if (link && texts.view) adjust(texts.view, { dark, mayEdit: free, link });
  }, [link, dark, free, words]);
}

/** @param {SourceTexts} texts what is wrong is underlined where it is */
function useMarks(texts) {
  const link = texts.shown.value?.link;
  const found = problems.value;
  const free = mayEdit.value;
  useEffect(() => {
    const { view } = texts;
    if (!link || !view) return;
    const marks = marksOf(found, link.file, view.state.doc);
    const drawn = marks.map(({ problem, ...mark }) => ({ ...mark, actions: fixOf(problem, free) }));
    view.dispatch(setDiagnostics(view.state, drawn));
  }, [link, found, free]);
}

/** @param {Problem} problem @param {boolean} free @returns {{name: string, apply: () => void}[]} a click on it where it is underlined */
function fixOf(problem, free) {
  if (!free || !problem.fix || !canMend(problem)) return [];
  return [{ name: problem.fix.label, apply: () => void mend(problem) }];
}

/** @param {SourceTexts} texts what is saved is no longer marked as changed */
function useSaved(texts) {
  const link = texts.shown.value?.link;
  const unsaved = history.value.unsaved_files;
  useEffect(() => {
    if (!link || !texts.view || unsaved.includes(link.file)) return;
    texts.view.dispatch({ effects: setSaved.of(link.shared.known) });
  }, [link, unsaved]);
}

/** @param {SourceTexts} texts */
function useLights(texts) {
  const link = texts.shown.value?.link;
  const places = litPlaces.value;
  useEffect(() => {
    if (!link || !texts.view) return;
    const lines = places.filter(({ file }) => file === link.file).map(({ line }) => line);
    texts.view.dispatch({ effects: setLit.of(lines) });
  }, [link, places]);
}

/** @param {SourceTexts} texts another panel asked for a line */
function useWanted(texts) {
  const wanted = wantedPlace.value;
  const shown = texts.shown.value;
  useEffect(() => {
    if (wanted) openFile(wanted.file);
  }, [wanted]);
  useEffect(() => {
    if (!wanted || !shown?.link || shown.file !== wanted.file || !texts.view) return;
    wantedPlace.value = null;
    const { view } = texts;
    // After the panel that was brought to the front has its size.
    requestAnimationFrame(() => {
      goToPlace(view, wanted.line, wanted.column);
      view.focus();
    });
  }, [wanted, shown]);
}

const WORD = /^(?:<\/?[\w:.-]+|[\w:.-]*\w|\$\{[^}]*\}?)/;

/**
 * @typedef {object} Lines a text by its lines
 * @property {number} lines
 * @property {(number: number) => {from: number, to: number, text: string}} line from 1
 */

/**
 * Where in a text a problem is underlined.
 *
 * @param {readonly Problem[]} problems
 * @param {string} file
 * @param {Lines} doc
 * @returns {{from: number, to: number, severity: Problem["severity"], message: string, problem: Problem}[]} in order
 */
export function marksOf(problems, file, doc) {
  return problems
    .flatMap((problem) => {
      const { severity, sentence, place } = problem;
      if (place?.file !== file || !place.line || place.line > doc.lines) return [];
      const line = doc.line(place.line);
      return [{ ...stretch(line, place.column), severity, message: sentence, problem }];
    })
    .sort((a, b) => a.from - b.from);
}

/**
 * The word at a column, the whole tag where a tag begins there, or the whole line.
 *
 * @param {{from: number, to: number, text: string}} line
 * @param {number} column from 1; 0: not known
 */
function stretch({ from, to, text }, column) {
  const indent = text.length - text.trimStart().length;
  if (column < 1 || column > text.length)
    return { from: Math.min(from + indent, to), to: from + text.trimEnd().length || to };
  const rest = text.slice(column - 1);
  const size = tagLength(rest) || WORD.exec(rest)?.[0].length || 1;
  return { from: from + column - 1, to: Math.min(from + column - 1 + size, to) };
}

/** @param {string} text that may begin with a tag @returns {number} 0: it does not */
function tagLength(text) {
  return /^<[\w:.-]+(?:"[^"]*"|'[^']*'|[^"'>])*>?/.exec(text)?.[0].trimEnd().length ?? 0;
}
