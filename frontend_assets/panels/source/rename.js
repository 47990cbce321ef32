/** Another name for what stands at the cursor, wherever it is named: the places first, then Enter. */

/** @import { EditorView } from "vendor/codemirror.js" */
/** @import { Meaning, RenamingAnswer } from "../../types/wire.d.ts" */
/** @import { TextLink } from "./shared-text.js" */

import { t } from "../../lib/i18n.js";
import { placeText } from "../../lib/paths.js";
import { mayEdit } from "../../model/connection.js";
import { ask } from "../../model/requests.js";
import { notify } from "../../model/view.js";
import { RefusedError, send } from "../../model/wire.js";
import { closePeek, lookUp, made, peek, placeButton } from "./meaning.js";

const REST_MS = 200;
const PLACES_SHOWN = 200;
const RENAMED = new Set(["property", "arg", "macro", "parameter", "block"]);

/** @param {TextLink} link @param {EditorView} view @param {number} pos @returns {true} */
export function renameAt(link, view, pos) {
  if (closePeek(view) || !mayEdit.peek()) return true;
  lookUp(link, pos).then((meaning) => {
    if (!meaning || !RENAMED.has(meaning.kind)) notify(t("language.nothing_to_rename"));
    else show(link, view, pos, meaning);
  });
  return true;
}

/** @param {TextLink} link @param {EditorView} view @param {number} pos @param {Meaning} meaning */
function show(link, view, pos, meaning) {
  const card = new RenameCard(link, pos, meaning, () => closePeek(view));
  peek(view, Math.min(Math.max(meaning.start, 0), view.state.doc.length), card.element);
}

/** A field for the name, what it would change, and the button that does it. */
class RenameCard {
  /** @type {RenamingAnswer | null} what the name in the field would change; null: not known yet, or refused */
  #known = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #later;
  /** Enter came before the answer did. */
  #hurried = false;

  /** @param {TextLink} link @param {number} offset @param {Meaning} meaning @param {() => void} close */
  constructor(link, offset, { kind, name }, close) {
    this.link = link;
    this.offset = offset;
    this.old = name;
    this.close = close;
    const title = t("rename.title", { kind: t(`language.kind.${kind}`), name });
    this.field = made("input", "rename-field");
    Object.assign(this.field, { type: "text", value: name, spellcheck: false, maxLength: 200 });
    this.field.setAttribute("aria-label", t("rename.new"));
    this.button = made("button", "button small primary", t("rename.go"));
    Object.assign(this.button, { type: "button", disabled: true });
    this.said = made("div", "rename-said muted", t("rename.hint"));
    this.said.setAttribute("role", "status");
    this.list = made("ul", "");
    const line = made("div", "rename-line", this.field, this.button);
    this.element = made("div", "meaning place-list rename", made("div", "meaning-head", title));
    this.element.append(line, this.said, this.list);
    this.element.setAttribute("role", "dialog");
    this.element.setAttribute("aria-label", title);
    this.#listen();
  }

  #listen() {
    this.field.addEventListener("focus", () => this.field.select(), { once: true });
    this.field.addEventListener("input", () => this.#typed());
    this.field.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      this.#hurried = this.#known === null;
      this.#rename();
    });
    this.button.addEventListener("click", () => this.#rename());
  }

  #typed() {
    this.#known = null;
    this.#hurried = false;
    this.button.disabled = true;
    clearTimeout(this.#later);
    this.#later = setTimeout(() => this.#look(), REST_MS);
  }

  get #wanted() {
    return this.field.value.trim();
  }

  async #look() {
    const name = this.#wanted;
    if (name === "" || name === this.old) return this.#say(t("rename.hint"), []);
    const place = { file: this.link.file, offset: this.offset, name };
    try {
      const answer = await send({ type: "get_renaming", ...place });
      if (answer.type === "renaming" && name === this.#wanted) this.#show(answer);
    } catch (error) {
      if (error instanceof RefusedError && error.kind !== "SupersededError")
        this.#say(error.message, [], true);
    }
    return undefined;
  }

  /** @param {RenamingAnswer} answer */
  #show(answer) {
    this.#known = answer;
    this.button.disabled = false;
    const files = t("rename.files", { count: answer.files });
    const words = [t("rename.count", { count: answer.count, files })];
    if (answer.kind === "arg") words.push(t("rename.arg"));
    const lines = answer.places.slice(0, PLACES_SHOWN).map(({ place, line, in_run: inRun }) => {
      const button = placeButton(place, placeText(place));
      button.append(made("code", "muted", line));
      if (!inRun) button.append(made("span", "meaning-kind", t("language.maybe")));
      return made("li", "", button);
    });
    this.#say(words.join(" · "), lines);
    if (this.#hurried) this.#rename();
  }

  /** @param {string} words @param {HTMLElement[]} lines @param {boolean} [bad] */
  #say(words, lines, bad = false) {
    this.said.textContent = words;
    this.said.classList.toggle("bad", bad);
    this.list.replaceChildren(...lines);
  }

  async #rename() {
    const known = this.#known;
    if (!known) return;
    const { count, new: name, old } = known;
    const { link, offset } = this;
    this.close();
    if (await ask({ type: "rename", file: link.file, offset, name, count }))
      notify(t("rename.done", { old, new: name, count }));
  }
}
