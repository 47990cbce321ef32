/** One property: its name, what it is set to, and what that came to. */

/** @import { Writer } from "./editors.js" */
/** @import { Effects, SiteView } from "../../types/wire.d.ts" */
/** @import { Signal } from "vendor/preact.js" */

import { html, signal, useComputed, useEffect, useMemo } from "vendor/preact.js";
import { isExpression } from "../../lib/expressions.js";
import { createGesture } from "../../lib/gesture.js";
import { t } from "../../lib/i18n.js";
import { latestSender } from "../../lib/latest.js";
import { formatNumber, shownNumber, shownNumbers, toDegrees } from "../../lib/numbers.js";
import { placeText } from "../../lib/paths.js";
import { isChanged, names, shortName } from "../../lib/sites.js";
import { Icon, IconButton, MenuButton } from "../../lib/ui.js";
import { mayEdit } from "../../model/connection.js";
import { documentState, problems, showingLastGood, site } from "../../model/document.js";
import { countedAspects, effects, hoverSite, pointedWords } from "../../model/origin.js";
import { editSite, resetSite, setArgument } from "../../model/requests.js";
import { hovered } from "../../model/selection.js";
import { cursorSites, showSource } from "../../model/source.js";
import { degrees } from "../../model/view.js";
import { Editor } from "./editors.js";

/** @param {{site: Signal<SiteView>}} props */
export function PropertyRow({ site: followed }) {
  const site = followed.value;
  const writer = useMemo(() => createWriter(followed), [followed]);
  const attempt = useAttempt(writer, site);
  const failure = failureOf(site, attempt !== null);
  const changed = isChanged(site) || attempt !== null;
  const link = site.owner.startsWith("link:") ? site.owner.slice(5) : null;
  const atCursor = useComputed(() => cursorSites.value.has(site.id)).value;
  const states = [
    failure && "bad",
    changed && "changed",
    site.reads === 0 && "idle",
    atCursor && "at-cursor",
  ]
    .filter(Boolean)
    .join(" ");
  const text = attempt ?? site.argument ?? site.text;
  return html`<div class=${`property ${states}`} role="group" aria-label=${site.name} data-site=${site.id}
    onPointerEnter=${() => {
      if (link) hovered.value = link;
      hoverSite(site.id);
    }} onPointerLeave=${() => {
      if (link) hovered.value = null;
      hoverSite(null);
    }} onFocusIn=${() => hoverSite(site.id)} onFocusOut=${() => hoverSite(null)}>
    <div class="property-head">
      <${Name} site=${site} changed=${changed} />
      <${Editor} part="head" site=${site} text=${text} writer=${writer} invalid=${failure !== null} />
      <${RowMenu} site=${site} writer=${writer} />
    </div>
    <${Editor} part="below" site=${site} text=${text} writer=${writer} invalid=${failure !== null} />
    ${failure === null && html`<${Result} site=${site} text=${text} />`}
    ${failure && html`<p class="note bad" role="alert"><${Icon} name="error" size=${13} />${failure}</p>`}
    ${site.argument !== null && html`<${PassedNote} site=${site} />`}
    ${site.reads === 0 && html`<p class="note">${t("property.no_effect")}</p>`}
    ${site.widget.help && html`<p class="note">${site.widget.help}</p>`}
  </div>`;
}

/** @param {Signal<SiteView>} followed @returns {Writer} */
function createWriter(followed) {
  const gesture = createGesture();
  /** @type {Signal<string | null>} */
  const attempt = signal(null);
  const sender = latestSender((/** @type {{text: string, id: string}} */ { text, id }) => {
    const site = followed.peek();
    return site.argument === null ? editSite(site.id, text, id) : setArgument(site.name, text);
  });
  return {
    attempt,
    write(text, { held = false } = {}) {
      attempt.value = text;
      sender.push({ text, id: gesture.id() });
      if (held) gesture.hold();
    },
    end(stepped = false) {
      if (stepped) gesture.release();
      else gesture.end();
      return sender.settled();
    },
  };
}

/** @param {Writer} writer @param {SiteView} site @returns {string | null} the text that failed, while it does */
function useAttempt({ attempt }, site) {
  const failing = showingLastGood.value;
  useEffect(() => {
    attempt.value = null;
  }, [site]);
  useEffect(() => {
    if (!failing) attempt.value = null;
  }, [failing]);
  return failing && attempt.value !== (site.argument ?? site.text) ? attempt.value : null;
}

/** @param {SiteView} site @param {boolean} tried @returns {string | null} the error that stands at its very line */
function failureOf(site, tried) {
  const found = problems.value.filter(
    ({ severity, place }) =>
      severity === "error" && place?.file === site.file && place.line === site.line,
  );
  // Several texts may share a line: only one that was changed, or that is named, is to blame.
  const own = found.find(({ sentence }) => names(sentence, site.name));
  const failure = own ?? (tried || isChanged(site) ? found[0] : undefined);
  return failure?.sentence ?? null;
}

/** @param {{site: SiteView, changed: boolean}} props */
function Name({ site, changed }) {
  const reset = t("property.reset", { name: site.name });
  const was = t("property.saved", { text: site.saved_text ?? "" });
  // Of a long path its end tells most.
  const tail = site.kind === "literal" || site.kind === "yaml" ? "tail" : "";
  return html`<span class=${`property-name ${tail}`} title=${`${site.name}\n${placeText(site)}`}><bdi>${shortName(site)}</bdi></span>
    ${
      changed &&
      html`<${IconButton} icon="reset" size=${13} class="reset" label=${reset} hint=${`${reset}\n${was}`}
      disabled=${!mayEdit.value} onClick=${() => resetSite(site.id)} />`
    }`;
}

/** Characters of a result that fit beside its kind. */
const ONE_LINE = 40;

/** @param {{site: SiteView, text: string}} props what an expression came to */
function Result({ site, text }) {
  if (!isExpression(text) || site.value === "") return null;
  const several = site.values.length > 1;
  const value = several
    ? shownNumbers(site.values.slice(0, 4).join(", ")) + (site.values.length > 4 ? ", …" : "")
    : resultText(site);
  // A path, say: its end tells most, and what comes before it is known from the others.
  if (value.length > ONE_LINE && !/\s/.test(value)) {
    return html`<p class="result path" title=${value}><span class="numbers">=</span><span class="result-path"><bdi>${value}</bdi></span></p>`;
  }
  return html`<p class="result"><span class="numbers" title=${several ? site.values.join(", ") : site.value}>= ${value}</span>
    <span class="muted"> · ${several ? t("property.values", { count: site.values.length }) : t("property.expression")}</span></p>`;
}

/** @param {SiteView} site */
function resultText({ number, value, widget }) {
  if (number === null) return shownNumbers(value);
  if (widget.unit === "rad" && degrees.value) return `${shownNumber(toDegrees(number))} °`;
  return `${shownNumber(number)} ${widget.unit}`.trim();
}

/** @param {{site: SiteView}} props an argument that was passed wins over what the file says */
function PassedNote({ site }) {
  return html`<p class="note passed">${t("property.passed", { text: site.text || "''" })}
    ${
      mayEdit.value &&
      html`<button type="button" class="text-button" onClick=${() => setArgument(site.name, null)}>
      ${t("property.unpass")}</button>`
    }</p>`;
}

/** @param {{site: SiteView, writer: Writer}} props */
function RowMenu({ site, writer }) {
  const label = t("property.menu", { name: site.name });
  return html`<${MenuButton} class="icon-button row-menu" label=${label} items=${() => menuItems(site, writer)}>
    <${Icon} name="dots" size=${14} /><//>`;
}

/** @param {SiteView} site @param {Writer} writer @returns {import("../../lib/ui.js").MenuItem[]} */
function menuItems(site, writer) {
  const locked = !mayEdit.value;
  /** @type {import("../../lib/ui.js").MenuItem[]} */
  const items = [{ label: `${placeText(site)} · ${t(`kind.${site.kind}.one`)}`, heading: true }];
  items.push({
    label: t("property.show_source"),
    icon: "source",
    run: () => showSource(site.file, site.line),
  });
  items.push({
    label: t("property.show_effects"),
    icon: "origin",
    run: () => hoverSite(site.id),
  });
  if (isExpression(site.text) && site.number !== null && site.argument === null) {
    const number = formatNumber(site.number);
    const run = () => {
      writer.write(number);
      writer.end();
    };
    items.push({
      label: t("property.replace", { number }),
      icon: "properties",
      disabled: locked,
      run,
    });
  }
  if (isChanged(site)) {
    const label = t("property.reset_to", { text: site.saved_text ?? "" });
    items.push({ label, icon: "reset", disabled: locked, run: () => resetSite(site.id) });
  }
  if (site.kind === "arg") items.push(argumentItem(site, locked));
  if (site.widget.unit === "rad") items.push(...angleItems());
  if (documentState.value?.read_only.includes(site.file))
    items.push({ label: t("property.read_only"), icon: "lock", disabled: true });
  return items;
}

/** @param {SiteView} site @param {boolean} locked @returns {import("../../lib/ui.js").MenuItem} */
function argumentItem({ name, argument, value, text }, locked) {
  return argument === null
    ? {
        label: t("property.pass"),
        icon: "link",
        disabled: locked,
        run: () => setArgument(name, value || text),
      }
    : {
        label: t("property.unpass"),
        icon: "reset",
        disabled: locked,
        run: () => setArgument(name, null),
      };
}

/** @returns {import("../../lib/ui.js").MenuItem[]} */
function angleItems() {
  return [false, true].map((on) => ({
    label: on ? t("angles.degrees") : t("angles.radians"),
    checked: degrees.value === on,
    run: () => {
      degrees.value = on;
    },
  }));
}

/** One line that says in words what the property under the pointer shapes. */
export function EffectLine() {
  const known = effects.value;
  const one = known && site(known.site)?.value;
  const words = known ? effectWords(known) : "";
  return html`<p class="effect-line" role="status" title=${words}>
    <span>${one ? html`<strong>${shortName(one)}</strong> ${words}` : pointedWords.value || t("effects.hint")}</span></p>`;
}

/** @param {Effects} known @returns {string} */
function effectWords(known) {
  const { counts, decisions } = known;
  const answer = countedAspects(counts).map(({ aspect, count }) =>
    t(`effects.${aspect}`, { count }),
  );
  const there = thereWords(known);
  if (there) answer.unshift(there);
  // A condition that is not met has nothing to show for itself, and yet is decided here.
  else if (!counts.presence && decisions > 0)
    answer.push(t("effects.decisions", { count: decisions }));
  return answer.length > 0 ? answer.join(", ") : t("effects.none");
}

/** @param {Effects} effects @returns {string} what is there as a whole because of it; empty: nothing */
function thereWords({ links_there: links, joints_there: joints }) {
  const parts = [
    ...(links > 0 ? [t("links.count", { count: links })] : []),
    ...(joints > 0 ? [t("joints.count", { count: joints })] : []),
  ];
  return parts.length > 0 ? t("effects.there", { what: parts.join(` ${t("and")} `) }) : "";
}
