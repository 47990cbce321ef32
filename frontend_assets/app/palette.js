/** The palette: every command, panel, property, link and file by its name. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { shownText } from "../lib/expressions.js";
import { t } from "../lib/i18n.js";
import { shortcutText } from "../lib/keys.js";
import { shortPath } from "../lib/paths.js";
import { Dialog, Icon } from "../lib/ui.js";
import { commandById, commandLabel, commands, onMac } from "./commands.js";
import { mayEdit } from "./state/connection.js";
import { allSites, documentState, robot, siteOrder } from "./state/document.js";
import { showFile } from "./state/source.js";
import { variants } from "./state/variants.js";
import { propertyFilter, soughtSite } from "./state/view.js";
import { applyVariant } from "./variants.js";
import { focusLink } from "./viewport.js";

/** @typedef {{key: string, icon: string, label: string, hint: string, run: () => void}} Choice */

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

/** @param {string} text @returns {Choice[]} whose words all occur, those that begin with them first */
function found(text) {
  const words = text.trim().toLowerCase().split(/\s+/).filter(Boolean);
  const all = [
    ...commandChoices(),
    ...(words.length > 0
      ? [...propertyChoices(), ...linkChoices(), ...fileChoices(), ...variantChoices()]
      : []),
  ];
  const fits = all.filter(({ label }) => words.every((word) => label.toLowerCase().includes(word)));
  const first = words[0] ?? "";
  const start = new RegExp(`(^|[ :_.])${first.replace(/\W/g, "\\$&")}`, "i");
  const begins = (/** @type {Choice} */ { label }) => Number(start.test(label));
  return first ? fits.sort((a, b) => begins(b) - begins(a)).slice(0, SHOWN) : fits;
}

/** @returns {Choice[]} */
function commandChoices() {
  return commands.value
    .filter(({ id, enabled }) => id !== "palette" && (enabled?.() ?? true))
    .map((command) => {
      const key = command.keys?.[0];
      return {
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
    if (!site) return [];
    const run = () => {
      propertyFilter.value = "";
      commandById("panel.properties")?.run();
      soughtSite.value = id;
    };
    return [
      {
        key: id,
        icon: "properties",
        label: t("palette.property", { name: site.name }),
        hint: shownText(site.argument ?? site.text),
        run,
      },
    ];
  });
}

/** @returns {Choice[]} */
function linkChoices() {
  return (robot.value?.links ?? []).map(({ name }) => ({
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
  return variants.value.variants.map(({ name, note }) => ({
    key: `variant ${name}`,
    icon: "variants",
    label: t("palette.variant", { name }),
    hint: shownText(note),
    run: () => void applyVariant(name),
  }));
}

/** @returns {Choice[]} */
function fileChoices() {
  const state = documentState.value;
  return (state?.files ?? []).map((file) => ({
    key: `file ${file}`,
    icon: "fileCode",
    label: t("palette.file", { name: shortPath(file, state?.root ?? "") }),
    hint: "",
    run: () => showFile(file),
  }));
}
