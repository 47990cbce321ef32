/** The open texts behind the source panel's one view: fetched when first shown, followed until closed. */

/**
 * @import { ChangeSet, EditorState, EditorView, StateEffect } from "vendor/codemirror.js"
 * @import { Signal } from "vendor/preact.js"
 * @import { TextLink } from "../app/texts.js"
 */

import { signal } from "vendor/preact.js";
import { redo, undo } from "../app/actions.js";
import { commandById } from "../app/commands.js";
import { mayEdit } from "../app/state/connection.js";
import { cursorPlace, shownFile } from "../app/state/source.js";
import { theme } from "../app/state/view.js";
import { linkText } from "../app/texts.js";
import { RefusedError } from "../app/wire.js";
import { t } from "../lib/i18n.js";
import { commonExtensions, fromElsewhere, stateOf, tellCursor } from "./source-editor.js";

/**
 * @typedef {object} Shown what the panel draws
 * @property {string} file
 * @property {TextLink | null} link null: not here yet, or not to be had
 * @property {string} reason why it cannot be shown
 */

/**
 * @typedef {object} Open
 * @property {TextLink | null} link
 * @property {EditorState | null} state as it was left, while another file is in front
 * @property {StateEffect<unknown> | null} scroll
 */

/**
 * @typedef {object} Texts
 * @property {Signal<Shown | null>} shown
 * @property {EditorView | null} view
 * @property {(view: EditorView) => void} begin
 * @property {(file: string) => void} show
 * @property {(files: readonly string[]) => void} keepOnly the others are closed
 * @property {() => void} end
 */

/** @returns {Texts} */
export function createTexts() {
  /** @type {Map<string, Open>} */
  const open = new Map();
  /** @type {Signal<Shown | null>} */
  const shown = signal(null);
  /** Undo asked for here shows what it did. */
  let follow = false;
  const events = {
    onCursor: (/** @type {number} */ line, /** @type {number} */ column) => {
      cursorPlace.value = { file: shownFile.value, line, column };
    },
    onUndo: () => step("undo", undo),
    onRedo: () => step("redo", redo),
  };
  const common = commonExtensions(events);

  /** @param {string} id @param {() => Promise<void>} run */
  async function step(id, run) {
    if (!(commandById(id)?.enabled?.() ?? true)) return;
    follow = true;
    await run();
    follow = false;
  }

  /** @param {string} file @param {ChangeSet} changes */
  function apply(file, changes) {
    const one = open.get(file);
    const spec = { changes, annotations: fromElsewhere.of(true) };
    if (shown.value?.file === file && shown.value.link && texts.view) {
      texts.view.dispatch(
        spec,
        follow
          ? { selection: { anchor: endOf(changes) }, scrollIntoView: true, sequential: true }
          : {},
      );
    } else if (one?.state) one.state = one.state.update(spec).state;
  }

  /** @param {string} file */
  async function fetch(file) {
    const one = { link: null, state: null, scroll: null };
    open.set(file, one);
    let reason = "";
    try {
      await adopt(file, one);
    } catch (error) {
      open.delete(file);
      reason = error instanceof RefusedError ? error.message : t("source.lost");
    }
    if (shownFile.value !== file) return;
    if (reason) shown.value = { file, link: null, reason };
    else show(file);
  }

  /** @param {string} file @param {Open} one */
  async function adopt(file, one) {
    const link = await linkText(file, (changes) => apply(file, changes));
    if (open.get(file) !== one) return link.close();
    one.link = link;
    const options = { dark: theme.value === "dark", mayEdit: mayEdit.value, more: [] };
    one.state = stateOf(link, common, options);
    return undefined;
  }

  function leave() {
    const before = shown.value?.link ? open.get(shown.value.file) : undefined;
    if (!before || !texts.view) return;
    before.state = texts.view.state;
    before.scroll = texts.view.scrollSnapshot();
  }

  /** @param {string} file */
  function show(file) {
    const one = open.get(file);
    if (one && shown.value?.file === file && shown.value.link) return;
    leave();
    if (one) enter(one);
    else if (file) fetch(file);
    shown.value = file ? { file, link: one?.link ?? null, reason: "" } : null;
  }

  /** @param {Open} one */
  function enter(one) {
    if (!one.state || !texts.view) return;
    texts.view.setState(one.state);
    tellCursor(one.state, events);
    if (one.scroll) texts.view.dispatch({ effects: one.scroll });
    one.state = null;
  }

  /** @type {Texts} */
  const texts = {
    shown,
    view: null,
    begin(view) {
      texts.view = view;
    },
    show,
    keepOnly(files) {
      for (const [file, { link }] of open) {
        if (files.includes(file)) continue;
        link?.shared.flush();
        link?.close();
        open.delete(file);
      }
    },
    end() {
      texts.keepOnly([]);
      texts.view?.destroy();
      texts.view = null;
    },
  };
  return texts;
}

/** @param {ChangeSet} changes @returns {number} where the last of them ends in the new text */
function endOf(changes) {
  let end = 0;
  changes.iterChangedRanges((_, __, ___, to) => {
    end = to;
  });
  return end;
}
