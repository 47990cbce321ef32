/** The open texts behind the source panel's one view: fetched when first shown, followed until closed. */

/** @import { ChangeSet, EditorState, EditorView, StateEffect } from "vendor/codemirror.js" */
/** @import { Signal } from "vendor/preact.js" */
/** @import { TextLink } from "./shared-text.js" */

import { signal } from "vendor/preact.js";
import { commandById } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { mayEdit } from "../../model/connection.js";
import { redo, undo } from "../../model/requests.js";
import { cursorPlace, shownFile } from "../../model/source.js";
import { theme } from "../../model/view.js";
import { RefusedError } from "../../model/wire.js";
import { commonExtensions, fromElsewhere, kindOfText, stateOf, tellCursor } from "./editor.js";
import { languageOf } from "./language.js";
import { pointing, selecting } from "./selection.js";
import { linkText } from "./shared-text.js";

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

export class SourceTexts {
  /** @type {Signal<Shown | null>} */
  shown = signal(null);
  /** @type {EditorView | null} */
  view = null;
  /** @type {Map<string, Open>} */
  #open = new Map();
  /** Undo asked for here shows what it did. */
  #follows = false;
  #events = {
    onCursor: (/** @type {number} */ line, /** @type {number} */ column) => {
      cursorPlace.value = { file: shownFile.value, line, column };
    },
    onUndo: () => this.#step("undo", undo),
    onRedo: () => this.#step("redo", redo),
  };
  #common = commonExtensions(this.#events);

  /** @param {EditorView} view draws the text in front from now on */
  begin(view) {
    this.view = view;
  }

  end() {
    this.keepOnly([]);
    this.view?.destroy();
    this.view = null;
  }

  /** @param {string} file comes to the front; empty: none */
  show(file) {
    const one = this.#open.get(file);
    if (one && this.shown.value?.file === file && this.shown.value.link) return;
    this.#leave();
    if (one) this.#enter(one);
    else if (file) this.#fetch(file);
    this.shown.value = file ? { file, link: one?.link ?? null, reason: "" } : null;
  }

  /** @param {readonly string[]} files the others are closed, once what was typed in them has arrived */
  keepOnly(files) {
    for (const [file, { link }] of this.#open) {
      if (files.includes(file)) continue;
      this.#open.delete(file);
      link?.shared.settled().then(link.close);
    }
  }

  /** @param {string} id of the page's command @param {() => Promise<void>} run */
  async #step(id, run) {
    if (!(commandById(id)?.enabled?.() ?? true)) return;
    this.#follows = true;
    await run();
    this.#follows = false;
  }

  /** @param {string} file @param {ChangeSet} changes that came from elsewhere */
  #apply(file, changes) {
    const one = this.#open.get(file);
    const spec = { changes, annotations: fromElsewhere.of(true) };
    if (one?.state) one.state = one.state.update(spec).state;
    else if (one && this.view) this.view.dispatch(spec, this.#follows ? whereItIs(changes) : {});
  }

  /** @param {string} file */
  async #fetch(file) {
    /** @type {Open} */
    const one = { link: null, state: null, scroll: null };
    this.#open.set(file, one);
    const reason = await this.#adopt(file, one);
    if (this.#open.get(file) !== one) return;
    if (reason) this.#open.delete(file);
    if (shownFile.value !== file) return;
    if (reason) this.shown.value = { file, link: null, reason };
    else this.show(file);
  }

  /** @param {string} file @param {Open} one @returns {Promise<string>} why it cannot be shown */
  async #adopt(file, one) {
    try {
      const link = await linkText(file, (changes) => this.#apply(file, changes));
      if (this.#open.get(file) !== one) link.close();
      one.link = link;
      const options = {
        dark: theme.value === "dark",
        mayEdit: mayEdit.value,
        // Of a program no question is asked that is about a robot.
        more: ["xml", "yaml"].includes(kindOfText(file))
          ? [languageOf(link), pointing(link), selecting(link)]
          : [],
      };
      one.state = stateOf(link, this.#common, options);
      return "";
    } catch (error) {
      return error instanceof RefusedError ? error.message : t("source.lost");
    }
  }

  #leave() {
    const before = this.shown.value?.link ? this.#open.get(this.shown.value.file) : undefined;
    if (!before || !this.view) return;
    before.state = this.view.state;
    before.scroll = this.view.scrollSnapshot();
  }

  /** @param {Open} one */
  #enter(one) {
    if (!one.state || !this.view) return;
    this.view.setState(one.state);
    tellCursor(one.state, this.#events);
    if (one.scroll) this.view.dispatch({ effects: one.scroll });
    one.state = null;
  }
}

/** @param {ChangeSet} changes @returns {import("vendor/codemirror.js").TransactionSpec} the cursor goes there */
function whereItIs(changes) {
  return { selection: { anchor: endOf(changes) }, scrollIntoView: true, sequential: true };
}

/** @param {ChangeSet} changes @returns {number} where the last of them ends in the new text */
function endOf(changes) {
  let end = 0;
  changes.iterChangedRanges((_, __, ___, to) => {
    end = to;
  });
  return end;
}
