/** Who is in the class: who asks for control, whose hand is raised, and what each may do here. */

/** @import { MemberView } from "../../types/wire.d.ts" */
/** @import { MenuItem } from "../../lib/ui.js" */

import { html, useSignal } from "vendor/preact.js";
import { address } from "../../lib/address.js";
import { t } from "../../lib/i18n.js";
import { EmptyState, Icon, IconButton, MenuButton, SearchBox, Switch } from "../../lib/ui.js";
import {
  classState,
  control,
  giveControl,
  leads,
  lowerHand,
  readmitMember,
  removeMember,
  setMemberRole,
  takeControl,
} from "../../model/class.js";
import { role } from "../../model/connection.js";
import { allCopies, copyOf, isHandedIn } from "../../model/copies.js";
import { gatherAll, lead, leading } from "../../model/following.js";
import { goTo } from "../../model/requests.js";
import { dialog } from "../../model/view.js";
import { listed } from "./listing.js";

const ROLES = /** @type {const} */ (["helper", "student", "guest"]);
/** Beyond so many the list has a box to search it by name. */
const MANY = 12;

export function PeoplePanel() {
  return html`<section class="panel-body" aria-label=${t("panel.people")}><${Content} /></section>`;
}

function Content() {
  const state = classState.value;
  const wanted = useSignal("");
  if (!leads.value || !state) return html`<${NotLeading} />`;
  if (!state.open && state.members.length === 0) return html`<${NobodyYet} />`;
  const rows = listed(state.members, wanted.value);
  return html`<div class="people">
    ${
      state.members.length > MANY &&
      html`<${SearchBox} label=${t("people.search")} value=${wanted.value} onInput=${(
        /** @type {string} */ text,
      ) => {
        wanted.value = text;
      }} />`
    }
    <p class="people-count" role="status">${t("people.count", { here: state.members.filter(({ here }) => here).length, all: state.members.length })}${state.viewers > 0 ? ` ${t("people.viewers", { count: state.viewers })}` : ""}</p>
    ${state.members.some(({ hand_s: raised }) => raised != null) && html`<button type="button" class="button small" onClick=${() => lowerHand()}>${t("people.lower_all")}</button>`}
    ${role.value === "presenter" && html`<${Guiding} />`}
    ${allCopies.value.some((one) => typeof one.handed_s === "number") && html`<a class="button small" href=${address("/api/copies")} download><${Icon} name="download" size=${14} />${t("people.copies.download")}</a>`}
    ${rows.length === 0 && html`<p class="note">${t(state.members.length > 0 ? "people.none_found" : "people.none")}</p>`}
    <ul class="people-list">${rows.map((member) => html`<${Person} key=${member.person} member=${member} />`)}</ul></div>`;
}

/** Whether the others see what the presenter looks at. */
function Guiding() {
  return html`<div class="people-guiding"><span>${t("people.leading")}<small>${t("people.leading.hint")}</small></span>
    <${Switch} label=${t("people.leading")} checked=${leading.value} onChange=${lead} /></div>
    <button type="button" class="button small" onClick=${gatherAll}><${Icon} name="users" size=${14} />${t("command.gather_all")}</button>`;
}

function NotLeading() {
  return html`<${EmptyState} icon="users" title=${t("people.not_leading")} />`;
}

function NobodyYet() {
  const share = () => {
    dialog.value = { kind: "class" };
  };
  return html`<${EmptyState} icon="users" title=${t("people.closed")}>
    ${role.value === "presenter" && html`<button type="button" class="button primary" onClick=${share}><${Icon} name="users" />${t("class.share")}…</button>`}<//>`;
}

/** @param {{member: MemberView}} props */
function Person({ member }) {
  const { name, here, removed } = member;
  const holds = control.value.holder === member.person;
  const state = removed ? "removed" : here ? "here" : "away";
  const looks = t(member.follows ? "people.follows" : "people.explores");
  return html`<li class=${`person ${state} ${holds ? "holds" : ""}`}>
    <span class="person-dot" role="img" aria-label=${t(`people.${state}`)} title=${t(`people.${state}`)}></span>
    <span class="person-name" title=${name}>${name}</span>
    ${member.role !== "student" && html`<span class="person-role">${t(`class.role.${member.role}`)}</span>`}
    ${member.hand_s != null && html`<${IconButton} icon="hand" size=${14} class="person-hand" label=${t("people.lower", { name })} onClick=${() => lowerHand(member.person)} />`}
    ${here && leading.value && html`<span class="person-looks" role="img" aria-label=${looks} title=${looks}><${Icon} name=${member.follows ? "watching" : "compass"} size=${14} /></span>`}
    ${html`<${Copy} who=${member.person} name=${name} />`}
    <span class="push"></span>
    ${removed ? html`<${Removed} member=${member} />` : html`<${Control} member=${member} holds=${holds} />`}
    ${role.value === "presenter" && !removed && html`<${MenuButton} label=${t("people.menu", { name })} items=${() => itemsOf(member)}><${Icon} name="dots" size=${14} /><//>`}</li>`;
}

/** @param {{who: string, name: string}} props their copy, to be looked at */
function Copy({ who, name }) {
  const copy = copyOf(who);
  if (!copy) return null;
  const handed = isHandedIn(copy);
  return html`<${IconButton} icon=${handed ? "check" : "fork"} size=${14} class=${handed ? "person-handed" : ""} onClick=${() => goTo(copy.document)}
    label=${t(handed ? "people.copy.handed" : "people.copy", { name, count: copy.changes })} />`;
}

/** @param {{member: MemberView}} props */
function Removed({ member }) {
  if (role.value !== "presenter") return null;
  return html`<button type="button" class="button small" onClick=${() => readmitMember(member.person)}>${t("people.readmit")}</button>`;
}

/** @param {{member: MemberView, holds: boolean}} props */
function Control({ member, holds }) {
  if (holds) {
    return html`<span class="person-holds">${t("people.holds")}</span>
      <button type="button" class="button small" onClick=${role.value === "presenter" ? takeControl : () => giveControl("")}>${t("class.control.take_back")}</button>`;
  }
  if (!member.here || member.role === "guest") return null;
  const asks = member.asks_s != null;
  return html`<button type="button" class=${`button small ${asks ? "primary" : "person-give"}`} title=${asks ? t("people.asks") : t("people.give.hint")}
    aria-label=${t("people.give.to", { name: member.name })} onClick=${() => giveControl(member.person)}>
    <${Icon} name="control" size=${13} /><span class="person-give-words">${t("people.give")}</span></button>`;
}

/** @param {MemberView} member @returns {MenuItem[]} */
function itemsOf(member) {
  return [
    { label: t("people.role"), heading: true },
    ...ROLES.map((one) => ({
      label: t(`class.role.${one}`),
      checked: member.role === one,
      run: () => void setMemberRole(member.person, one),
    })),
    { label: member.name, heading: true },
    { label: `${t("people.remove")}…`, icon: "close", run: () => askToRemove(member) },
  ];
}

/** @param {MemberView} member */
function askToRemove({ person, name }) {
  dialog.value = {
    kind: "confirm",
    title: t("people.remove.title", { name }),
    text: t("people.remove.text"),
    action: t("people.remove"),
    danger: true,
    run: () => void removeMember(person),
  };
}
