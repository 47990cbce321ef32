/** Every text of the files that can be turned: arguments, properties, YAML values and literals. */

/** @import { SiteGroup } from "../../lib/sites.js" */

import { html, useEffect, useSignal } from "vendor/preact.js";
import { commandById, commandLabel } from "../../lib/commands.js";
import { t } from "../../lib/i18n.js";
import { LongList } from "../../lib/long-list.js";
import { baseName, shortPath } from "../../lib/paths.js";
import { remembered } from "../../lib/remembered.js";
import { countKinds, groupSites, KINDS } from "../../lib/sites.js";
import { EmptyState, Icon, IconButton, SearchBox } from "../../lib/ui.js";
import {
  allSites,
  documentState,
  robot,
  site,
  siteOrder,
  sitesRevision,
} from "../../model/document.js";
import { followShaping, shaping } from "../../model/origin.js";
import { onlySelected, selected } from "../../model/selection.js";
import { propertyFilter, soughtSite } from "../../model/view.js";
import { followChoices } from "./editors.js";
import { EffectLine, PropertyRow } from "./row.js";

/** @type {import("vendor/preact.js").Signal<string[]>} */
const hiddenKinds = remembered("kinds.hidden", ["literal"], Array.isArray);
const ROW_PX = 58;
const HEADING_PX = 32;

export function PropertiesPanel() {
  const folded = useSignal(/** @type {ReadonlySet<string>} */ (new Set()));
  sitesRevision.value;
  const sites = allSites();
  const counts = countKinds(siteOrder.value, sites);
  const filter = currentFilter(counts);
  const groups = groupSites(siteOrder.value, sites, filter);
  const sought = soughtSite.value;
  useSought(folded);
  useEffect(followShaping, []);
  useEffect(followChoices, []);
  /** @param {string} key */
  const toggle = (key) => {
    const now = new Set(folded.value);
    if (!now.delete(key)) now.add(key);
    folded.value = now;
  };
  return html`<section class="panel-body properties-panel" aria-label=${t("panel.properties")}>
    <div class="panel-bar">
      <${SearchBox} label=${t("properties.filter")} value=${propertyFilter.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        propertyFilter.value = text;
      }} />
      <${LaunchButton} counts=${counts} />
      <${KindChips} counts=${counts} />
      <${SelectionChip} />
    </div>
    <div class="scroll">
      <${LongList} items=${groups} keyOf=${(/** @type {SiteGroup} */ { key }) => key} row=${roomOf(folded.value)}
        isKept=${(/** @type {SiteGroup} */ { sites: ids }) => sought !== null && ids.includes(sought)}
        draw=${(
          /** @type {SiteGroup} */ group,
        ) => html`<${Group} key=${group.key} group=${group} folded=${folded.value.has(group.key)}
          onToggle=${() => toggle(group.key)} />`} />
      ${groups.length === 0 && html`<${Nothing} counts=${counts} />`}
    </div>
    ${siteOrder.value.length > 0 && html`<${EffectLine} />`}
  </section>`;
}

/** @param {ReadonlySet<string>} folded keys @returns {(groups: SiteGroup[]) => string} how tall groups are about */
const roomOf = (folded) => (groups) => {
  const rows = groups.map(({ key, sites }) => (folded.has(key) ? 0 : sites.length));
  return `${groups.length * HEADING_PX + rows.reduce((sum, one) => sum + one, 0) * ROW_PX}px`;
};

/** @param {ReadonlyMap<string, number>} counts @returns {import("../../lib/sites.js").SiteFilter} */
function currentFilter(counts) {
  return {
    words: propertyFilter.value.trim(),
    kinds: shownKinds(counts),
    chosen: selectionSites(),
  };
}

/** @param {ReadonlyMap<string, number>} counts @returns {ReadonlySet<string>} never none, when there is one */
function shownKinds(counts) {
  const present = KINDS.filter((kind) => counts.has(kind));
  const wanted = present.filter((kind) => !hiddenKinds.value.includes(kind));
  return new Set(wanted.length > 0 ? wanted : present);
}

/** @returns {ReadonlySet<string> | null} ids of what shapes the selected link or the joint above it; null: no such filter */
function selectionSites() {
  if (!onlySelected.value || !selected.value) return null;
  return shaping.value?.link === selected.value ? shaping.value.sites : ownSites(selected.value);
}

/** @param {string} link @returns {ReadonlySet<string>} the numbers written at it: known before the studio tells the others */
function ownSites(link) {
  const joint = robot.value?.joints.find(({ child }) => child === link)?.name;
  const owners = [`link:${link}`, `joint:${joint}`];
  const own = [...allSites().values()].filter(({ owner }) => owners.includes(owner));
  return new Set(own.map(({ id }) => id));
}

/** @param {{counts: ReadonlyMap<string, number>}} props */
function KindChips({ counts }) {
  const present = KINDS.filter((kind) => counts.has(kind));
  if (present.length < 2) return null;
  const shown = shownKinds(counts);
  /** @param {string} kind */
  const toggle = (kind) => {
    const now = present.filter((one) => (one === kind ? !shown.has(one) : shown.has(one)));
    if (now.length > 0)
      hiddenKinds.value = KINDS.filter((one) =>
        counts.has(one) ? !now.includes(one) : hiddenKinds.value.includes(one),
      );
  };
  return html`<div class="chips" role="group" aria-label=${t("properties.kinds")}>
    ${present.map(
      (kind) => html`<button key=${kind} type="button" class="chip" aria-pressed=${shown.has(kind)}
      title=${t(`kind.${kind}.hint`)} onClick=${() => toggle(kind)}>
      ${t(`kind.${kind}`)} <span class="numbers">${counts.get(kind)}</span></button>`,
    )}
  </div>`;
}

/** @param {{counts: ReadonlyMap<string, number>}} props all arguments at once, for a robot that has any */
function LaunchButton({ counts }) {
  const command = commandById("arguments");
  if (!counts.get("arg") || !command?.enabled?.()) return null;
  const label = `${commandLabel(command)}…`;
  return html`<${IconButton} icon="arguments" label=${label} onClick=${command.run} />`;
}

function SelectionChip() {
  if (!selected.value) return null;
  const toggle = () => {
    onlySelected.value = !onlySelected.value;
  };
  return html`<button type="button" class="chip selection" aria-pressed=${onlySelected.value} onClick=${toggle}>
    <${Icon} name="box" size=${13} />${t("properties.only", { name: selected.value })}</button>`;
}

/** @param {{counts: ReadonlyMap<string, number>}} props */
function Nothing({ counts }) {
  const words = propertyFilter.value.trim();
  if (siteOrder.value.length === 0) {
    if (!robot.value && documentState.value?.phase !== "failed") return null;
    const title = t(robot.value ? "properties.none" : "properties.no_robot");
    return html`<${EmptyState} icon="properties" title=${title} />`;
  }
  const everywhere = new Set(KINDS);
  const others = groupSites(siteOrder.value, allSites(), {
    words,
    kinds: everywhere,
    chosen: null,
  });
  const count = others.reduce((sum, group) => sum + group.sites.length, 0);
  const show = () => {
    hiddenKinds.value = [];
    onlySelected.value = false;
  };
  const title = words ? t("filter.nothing", { words }) : t("properties.none_here");
  return html`<${EmptyState} icon="search" title=${title}>
    ${count > 0 && counts.size > 0 && html`<button type="button" class="button" onClick=${show}>${t("properties.elsewhere", { count })}</button>`}
  <//>`;
}

/** @param {{group: SiteGroup, folded: boolean, onToggle: () => void}} props */
function Group({ group, folded, onToggle }) {
  const root = documentState.value?.root ?? "";
  const readOnly = documentState.value?.read_only.includes(group.file);
  const name = group.group || baseName(group.file);
  return html`<section class="group" aria-label=${name}>
    <h3><button type="button" aria-expanded=${!folded} onClick=${onToggle}>
      <${Icon} name=${folded ? "chevronRight" : "chevronDown"} size=${13} />
      <span class=${`group-name ${name.includes(".") ? "tail" : ""}`}><bdi>${name}</bdi></span>
      <span class="group-file" title=${shortPath(group.file, root)}>
        ${readOnly && html`<${Icon} name="lock" size=${11} />`}${folded ? group.sites.length : group.group ? baseName(group.file) : ""}</span>
    </button></h3>
    ${!folded && html`<${Rows} ids=${group.sites} />`}
  </section>`;
}

/** @param {{ids: string[]}} props drawn while they are near the view, or sought: only then can one be scrolled to */
function Rows({ ids }) {
  const sought = soughtSite.value;
  return html`<${LongList} items=${ids} keyOf=${String} row=${`${ROW_PX}px`} short=${0}
    isKept=${(/** @type {string} */ id) => id === sought} draw=${(/** @type {string} */ id) => {
      const one = site(id);
      return one && html`<${PropertyRow} key=${id} site=${one} />`;
    }} />`;
}

/** Brings a property into view that another part of the page asked for. @param {{value: ReadonlySet<string>}} folded */
function useSought(folded) {
  const id = soughtSite.value;
  useEffect(() => {
    if (!id) return;
    folded.value = new Set();
    const kind = site(id)?.peek().kind;
    hiddenKinds.value = hiddenKinds.value.filter((one) => one !== kind);
    // Two frames: the filter draws anew, then the piece that holds the row.
    requestAnimationFrame(() =>
      requestAnimationFrame(() => {
        const row = document.querySelector(`[data-site="${CSS.escape(id)}"]`);
        row?.scrollIntoView({ block: "center" });
        /** @type {HTMLElement | null | undefined} */ (
          row?.querySelector("input, select, button")
        )?.focus();
        soughtSite.value = null;
      }),
    );
  }, [id]);
}
