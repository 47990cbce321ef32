/** The help at one side of the window: a page, the list of all, or what a search finds. */

/** @import { Block } from "../lib/help-text.js" */

import { html, useEffect, useId, useLayoutEffect, useRef, useSignal } from "vendor/preact.js";
import { plainHelp, readHelp, textFiles } from "../lib/help-text.js";
import { language, t } from "../lib/i18n.js";
import { Icon, IconButton, SearchBox } from "../lib/ui.js";
import { theme } from "../model/view.js";
import {
  closeHelp,
  goBackInHelp,
  goToHelp,
  help,
  helpGroups,
  helpIcon,
  helpTitle,
  helpTrail,
  isOfPanel,
} from "./help.js";
import { drawnBlock } from "./help-drawing.js";

const ASSETS = new URL("../", import.meta.url).href;
const known = textFiles(ASSETS, readHelp);

/** @param {string} language @param {string} page @returns {Promise<readonly Block[]>} empty, when it cannot be had now */
const helpBlocks = (language, page) =>
  known(isOfPanel(page) ? `panels/${page}/help.${language}.md` : `help/${language}/${page}.md`);

/** @param {string} page @returns {string} address of its picture */
function helpPicture(page) {
  const name = isOfPanel(page) ? `panels/${page}/help` : `help/pictures/${page}`;
  return `${ASSETS}${name}-${theme.value}.webp`;
}

/** @param {{page: string, side: string, modal: boolean}} props */
function HelpSheet({ page, side, modal }) {
  const element = useRef(/** @type {HTMLDialogElement | null} */ (null));
  const words = useSignal("");
  const heading = useId();
  const close = () => {
    if (element.current) closeHelp(element.current);
  };
  useLayoutEffect(() => {
    if (modal) element.current?.showModal();
    else element.current?.show();
  }, []);
  // A page begins at its top, and is read and scrolled by keys at once.
  useLayoutEffect(() => {
    const text = element.current?.querySelector(".help-text");
    text?.scrollTo(0, 0);
    if (text instanceof HTMLElement) text.focus({ preventScroll: true });
  }, [page]);
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    if (event.defaultPrevented) return;
    if (event.key === "Escape") close();
    else if (event.altKey && event.key === "ArrowLeft") goBackInHelp();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  /** @param {string} to */
  const go = (to) => {
    words.value = "";
    goToHelp(to);
  };
  const title = page === "" ? t("help.title") : helpTitle(page);
  return html`<dialog ref=${element} class=${`help ${side}`} aria-labelledby=${heading} onKeyDown=${onKeyDown}
    onCancel=${(/** @type {Event} */ event) => {
      event.preventDefault();
      close();
    }}>
    <header><h2 id=${heading}>${title}</h2>
      ${page !== "" && html`<button type="button" class="button small" onClick=${() => go("")}>${t("help.all")}</button>`}
      <${IconButton} icon="close" label=${t("help.close")} onClick=${close} /></header>
    <${Search} words=${words} onChoose=${go} />
    <div class="help-text" tabindex="0" role="region" aria-label=${title}>
      ${words.value.trim() ? html`<${Results} words=${words.value} onChoose=${go} />` : html`<${Content} page=${page} onChoose=${go} />`}
    </div>
  </dialog>`;
}

/** @param {{words: import("vendor/preact.js").Signal<string>, onChoose: (page: string) => void}} props Enter takes the first that is found */
function Search({ words, onChoose }) {
  /** @param {KeyboardEvent} event */
  const onKeyDown = async (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    const [first] = searchHelp(await allTexts(), words.value);
    if (first) onChoose(first.page);
  };
  return html`<div class="help-search" onKeyDown=${onKeyDown}><${SearchBox} label=${t("help.search")} value=${words.value}
    onInput=${(/** @type {string} */ text) => {
      words.value = text;
    }} /></div>`;
}

/** @returns {Promise<HelpText[]>} */
async function allTexts() {
  const pages = Object.values(helpGroups()).flat();
  return Promise.all(
    pages.map(async (page) => ({
      page,
      title: helpTitle(page),
      text: plainHelp(await helpBlocks(language.value, page)),
    })),
  );
}

/** @param {{words: string, onChoose: (page: string) => void}} props */
function Results({ words, onChoose }) {
  const found = useSignal(/** @type {Found[] | null} */ (null));
  useEffect(() => {
    let wanted = true;
    allTexts().then((texts) => {
      if (wanted) found.value = searchHelp(texts, words);
    });
    return () => {
      wanted = false;
    };
  }, [words, language.value]);
  if (found.value === null) return null;
  if (found.value.length === 0)
    return html`<p class="nothing" role="status">${t("filter.nothing", { words })}</p>`;
  return html`<ul class="help-found" aria-label=${t("help.search")}>${found.value.map(
    ({ page, title, excerpt }) => html`<li key=${page}>
      <button type="button" class="help-entry" onClick=${() => onChoose(page)}><strong>${title}</strong><span>${excerpt}</span></button></li>`,
  )}</ul>`;
}

/** @param {{page: string, onChoose: (page: string) => void}} props */
function Content({ page, onChoose }) {
  return page === ""
    ? html`<${AllPages} onChoose=${onChoose} />`
    : html`<${Back} /><${Page} key=${page} page=${page} onChoose=${onChoose} />`;
}

function Back() {
  const last = helpTrail.value.at(-1);
  if (!last) return null;
  return html`<button type="button" class="text-button help-back" onClick=${goBackInHelp}>${t("help.back", { page: helpTitle(last) })}</button>`;
}

/** @param {{onChoose: (page: string) => void}} props */
function AllPages({ onChoose }) {
  return html`<nav aria-label=${t("help.all")}>${Object.entries(helpGroups()).map(
    ([group, pages]) => html`<section key=${group}><h3>${t(`help.group.${group}`)}</h3>
      <ul class="help-list">${pages.map(
        (
          page,
        ) => html`<li key=${page}><button type="button" class="help-entry" onClick=${() => onChoose(page)}>
          <${Icon} name=${helpIcon(page)} /><span>${helpTitle(page)}</span></button></li>`,
      )}</ul></section>`,
  )}</nav>`;
}

/** @param {{page: string, onChoose: (page: string) => void}} props */
function Page({ page, onChoose }) {
  const blocks = useSignal(/** @type {readonly Block[] | null} */ (null));
  useEffect(() => {
    let wanted = true;
    helpBlocks(language.value, page).then((read) => {
      if (wanted) blocks.value = read;
    });
    return () => {
      wanted = false;
    };
  }, [page, language.value]);
  if (blocks.value === null) return null;
  if (blocks.value.length === 0)
    return html`<p class="nothing" role="status">${t("help.lost")}</p>`;
  return html`<article class="help-article">${blocks.value.map((block) => drawnBlock(block, onChoose, helpPicture))}</article>`;
}

/** The sheet, where it is asked for; a window opened since then has it drawn anew over itself. */
export function HelpPlace() {
  const shown = help.value;
  return shown && html`<${HelpSheet} key=${String(shown.modal)} ...${shown} />`;
}

/** @typedef {{page: string, title: string, text: string}} HelpText */
/** @typedef {{page: string, title: string, excerpt: string}} Found */

const AROUND = 60;
const FOUND_MOST = 12;

/**
 * Finding a page of the help by words in it.
 *
 * @param {readonly HelpText[]} texts
 * @param {string} sought
 * @returns {Found[]} pages with every one of the words; those with a word in the title first
 */
export function searchHelp(texts, sought) {
  const words = sought.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return [];
  return texts
    .map((one) => ({ one, weight: weightOf(one, words) }))
    .filter(({ weight }) => weight > 0)
    .sort((a, b) => b.weight - a.weight)
    .slice(0, FOUND_MOST)
    .map(({ one }) => ({ page: one.page, title: one.title, excerpt: excerpt(one.text, words) }));
}

/** @param {HelpText} one @param {readonly string[]} words @returns {number} 0: a word is missing */
function weightOf({ title, text }, words) {
  const [named, said] = [title.toLowerCase(), text.toLowerCase()];
  if (!words.every((word) => named.includes(word) || said.includes(word))) return 0;
  const inTitle = words.filter((word) => named.includes(word)).length;
  const times = words.reduce((sum, word) => sum + said.split(word).length - 1, 0);
  return 1 + 100 * inTitle + Math.min(times, 50);
}

/** @param {string} text @param {readonly string[]} words @returns {string} whole words around the first that is found */
function excerpt(text, words) {
  const low = text.toLowerCase();
  const places = words.map((word) => low.indexOf(word)).filter((at) => at >= 0);
  const at = places.length > 0 ? Math.min(...places) : 0;
  const begin = at <= AROUND ? 0 : text.indexOf(" ", at - AROUND) + 1;
  const end = text.lastIndexOf(" ", at + 2 * AROUND);
  const cut = at + 2 * AROUND >= text.length || end <= at ? text.length : end;
  return `${begin > 0 ? "… " : ""}${text.slice(begin, cut)}${cut < text.length ? " …" : ""}`;
}
