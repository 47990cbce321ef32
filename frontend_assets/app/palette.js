/** The palette: every command, panel, property, link and file by its name. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { shownText } from "../lib/expressions.js";
import { t } from "../lib/i18n.js";
import { shortcutText } from "../lib/keys.js";
import { placeText, shortPath } from "../lib/paths.js";
import { ranked } from "../lib/ranking.js";
import { Dialog, Icon } from "../lib/ui.js";
import { commandById, commandLabel, commands, onMac } from "./commands.js";
import { compareWith } from "./menu-commands.js";
import { mayEdit } from "./state/connection.js";
import { allSites, documentState, robot, siteOrder } from "./state/document.js";
import { showFile } from "./state/source.js";
import { variants } from "./state/variants.js";
import { propertyFilter, soughtSite } from "./state/view.js";
import { applyVariant } from "./variants.js";
import { focusLink } from "./viewport.js";

/** @typedef {import("../lib/ranking.js").Ranked & {key: string, icon: string, hint: string, run: () => void}} Choice */

const SHOWN = 40;

/** @param {{onClose: () => void}} props */
export function Palette({ onClose }) {
  const words = useSignal("");
  const at = useSignal(0);
  const list = useRef(/** @type {HTMLElement | null} */ (null));
  const choices = found(words.value);
  const active = Math.min(at.value, choices.length - 1);
  useEffect(() => {
    list.current?.querySelector('[aria-selected="true"]')?.scrollIntoView({ block: "nearest" });
  }, [active]);
  /** @param {Choice | undefined} choice */
  const run = (choice) => {
    if (!choice) return;
    onClose();
    choice.run();
  };
  /** @param {KeyboardEvent} event */
  const onKeyDown = (event) => {
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (step) at.value = (active + step + choices.length) % Math.max(choices.length, 1);
    else if (event.key === "Enter") run(choices[active]);
    else return;
    event.preventDefault();
  };
  return html`<${Dialog} title=${t("command.palette")} closeLabel=${t("close")} class="palette" onClose=${onClose}>
    <input type="text" class="palette-input" role="combobox" aria-expanded="true" aria-controls="palette-list" data-first
      aria-activedescendant=${choices[active] ? `palette-${active}` : null} aria-label=${t("palette.hint")} placeholder=${t("palette.hint")}
      value=${words.value} spellcheck=${false} onKeyDown=${onKeyDown} onInput=${(
        /** @type {any} */ event,
      ) => {
        words.value = event.currentTarget.value;
        at.value = 0;
      }} />
    <div class="palette-list" id="palette-list" role="listbox" aria-label=${t("command.palette")} ref=${list}>
      ${choices.map(
        (
          choice,
          n,
        ) => html`<div key=${choice.key} id=${`palette-${n}`} role="option" class="palette-item"
        aria-selected=${n === active} onClick=${() => run(choice)} onPointerMove=${() => {
          at.value = n;
        }}><${Icon} name=${choice.icon} /><span class="palette-label">${choice.label}</span><kbd>${choice.hint}</kbd></div>`,
      )}
      ${choices.length === 0 && html`<p class="nothing">${t("filter.nothing", { words: words.value })}</p>`}
    </div>
  <//>`;
}

/** @param {string} text @returns {Choice[]} */
function found(text) {
  if (text.trim() === "") return commandChoices();
  const all = [
    ...commandChoices(),
    ...linkChoices(),
    ...variantChoices(),
    ...propertyChoices(),
    ...fileChoices(),
  ];
  return ranked(all, text).slice(0, SHOWN);
}

/** @returns {Choice[]} */
function commandChoices() {
  return commands.value
    .filter(({ id, enabled }) => id !== "palette" && (enabled?.() ?? true))
    .map((command) => {
      const key = command.keys?.[0];
      return {
        rank: "command",
        key: command.id,
        icon: command.icon,
        label: commandLabel(command),
        hint: key ? shortcutText(key, onMac) : "",
        run: command.run,
      };
    });
}

/** @returns {Choice[]} */
function propertyChoices() {
  const sites = allSites();
  return siteOrder.value.flatMap((id) => {
    const site = sites.get(id);
    return site ? [propertyChoice(site)] : [];
  });
}

/** @param {import("../types/wire.d.ts").SiteView} site @returns {Choice} texts without a name are told apart by their places */
function propertyChoice(site) {
  const unnamed = site.kind === "literal";
  const text = shownText(site.argument ?? site.text);
  return {
    rank: unnamed ? "literal" : "property",
    key: site.id,
    icon: "properties",
    label: t("palette.property", { name: site.name }),
    hint: unnamed ? `${text} · ${placeText(site)}` : text,
    run: () => {
      propertyFilter.value = "";
      commandById("panel.properties")?.run();
      soughtSite.value = site.id;
    },
  };
}

/** @returns {Choice[]} */
function linkChoices() {
  return (robot.value?.links ?? []).map(({ name }) => ({
    rank: "link",
    key: `link ${name}`,
    icon: "box",
    label: t("palette.link", { name }),
    hint: "",
    run: () => focusLink(name),
  }));
}

/** @returns {Choice[]} */
function variantChoices() {
  if (!mayEdit.value) return [];
  return variants.value.variants.flatMap(({ name, note }) => [
    {
      rank: "variant",
      key: `variant ${name}`,
      icon: "variants",
      label: t("palette.variant", { name }),
      hint: shownText(note),
      run: () => void applyVariant(name),
    },
    {
      rank: "variant",
      key: `compare ${name}`,
      icon: "compare",
      label: t("palette.compare", { name }),
      hint: "",
      run: () => compareWith({ kind: "variant", name }),
    },
  ]);
}

/** @returns {Choice[]} */
function fileChoices() {
  const state = documentState.value;
  return (state?.files ?? []).map((file) => ({
    rank: "file",
    key: `file ${file}`,
    icon: "fileCode",
    label: t("palette.file", { name: shortPath(file, state?.root ?? "") }),
    hint: "",
    run: () => showFile(file),
  }));
}
