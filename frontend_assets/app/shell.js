/** The frame of the page: bars, the dock between them, notices, and the tabs of a phone. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { later } from "../lib/loading.js";
import { Icon, IconButton, MenuButton } from "../lib/ui.js";
import { connection, documentId, role, turnedAway } from "../model/connection.js";
import { documentState, gone } from "../model/document.js";
import { movesOn, studioAway } from "../model/relays.js";
import { goTo, openPath } from "../model/requests.js";
import { activePanel, dialog, fullView, size } from "../model/view.js";
import { ControlBar } from "./control.js";
import { CopyBar } from "./copy-bar.js";
import { Dialogs } from "./dialogs.js";
import { help } from "./help.js";
import { placedPanels } from "./layouts.js";
import { DiskBars } from "./merge-dialog.js";
import { Notices } from "./notices.js";
import { PANELS, panelTitle } from "./panels.js";
import { LeftWorkBar, RestoredBar } from "./restored-work.js";
import { StatusBar } from "./status-bar.js";
import { Timeline } from "./timeline.js";
import { TopBar } from "./top-bar.js";
import { DropLayer } from "./uploads.js";

const SAY_AFTER_MS = 600;
const HelpPlace = later(async () => (await import("./help-sheet.js")).HelpPlace);
const StartCard = later(async () => (await import("./start-card.js")).StartCard);

/** @param {{onDock: (element: HTMLElement) => void}} props */
export function Shell({ onDock }) {
  const dock = useRef(/** @type {HTMLElement | null} */ (null));
  useEffect(() => {
    if (dock.current) onDock(dock.current);
  }, []);
  const alone = fullView.value && size.value !== "phone";
  return html`<div class=${`shell ${size.value} ${alone ? "full-view" : ""}`}>
    <${SkipLink} />
    <${TopBar} />
    <${ControlBar} />
    <${CopyBar} />
    <${LostBar} />
    <${AwayBar} />
    <${GoneBar} />
    <${RestoredBar} />
    <${LeftWorkBar} />
    <${DiskBars} />
    <main ref=${dock} id="dock" class="dock" aria-label=${t("dock")}></main>
    <${Timeline} />
    ${size.value === "phone" ? html`<${PhoneTabs} />` : html`<${StatusBar} />`}
    ${documentId.value === "" && html`<${StartCard} />`}
    ${dialog.value === null && html`<${Notices} />`}
    <${Dialogs} />
    ${help.value && html`<${HelpPlace} />`}
    <${DropLayer} />
    ${alone && html`<${LeaveFullView} />`}
  </div>`;
}

/** Who has no Escape key gets back, too. */
function LeaveFullView() {
  return html`<${IconButton} class="leave-full-view" icon="minimize" label=${t("command.leave_fullscreen")}
    hint=${`${t("command.leave_fullscreen")} (Esc)`} onClick=${() => commandById("leave_fullscreen")?.run()} />`;
}

/** The first stop of Tab: past the bar to where the work is. */
function SkipLink() {
  const skip = (/** @type {Event} */ event) => {
    event.preventDefault();
    commandById("next_panel")?.run();
  };
  return html`<a class="skip" href="#dock" onClick=${skip}>${t("skip")}</a>`;
}

/** @param {boolean} holds @returns {boolean} it has for a while: a blink is not worth a word */
function useLasting(holds) {
  const lasts = useSignal(false);
  useEffect(() => {
    if (!holds) {
      lasts.value = false;
      return undefined;
    }
    const timer = setTimeout(() => {
      lasts.value = true;
    }, SAY_AFTER_MS);
    return () => clearTimeout(timer);
  }, [holds]);
  return lasts.value;
}

/** Says that the studio went away. */
function LostBar() {
  if (!useLasting(connection.value === "lost")) return null;
  if (turnedAway.value) {
    return html`<div class="bar lost" role="alert"><${Icon} name="lock" /><span><strong>${t("turned_away")}</strong> ${t("turned_away.hint")}</span></div>`;
  }
  const [what, hint] = movesOn.value
    ? [t("relays.gone"), t("relays.gone.hint")]
    : [t("lost"), t("lost.hint")];
  return html`<div class="bar lost" role="alert"><span class="spinner"></span>
    <span><strong>${what}</strong> ${hint}</span></div>`;
}

/** Says that our relay is there, but not the studio behind it. */
function AwayBar() {
  if (!useLasting(studioAway.value)) return null;
  return html`<div class="bar away" role="status"><${Icon} name="info" /><span><strong>${t("relays.away")}</strong> ${t("relays.away.hint")}</span></div>`;
}

function GoneBar() {
  if (!gone.value) return null;
  const state = documentState.value;
  const again = () => (state ? openPath(state.path, { ...state.arguments }) : goTo(""));
  return html`<div class="bar gone" role="alert"><${Icon} name="info" /><span>${t("gone")}</span>
    ${role.value === "presenter" && state && html`<button type="button" class="button small" onClick=${again}>${t("gone.again")}</button>`}
    <button type="button" class="button small" onClick=${() => goTo("")}>${t("gone.home")}</button></div>`;
}

const PHONE_PANELS = placedPanels(PANELS, "phone", "tabs");

function PhoneTabs() {
  return html`<nav class="phone-tabs" aria-label=${t("panels")}>
    ${PHONE_PANELS.map(
      (
        id,
      ) => html`<button key=${id} type="button" aria-current=${activePanel.value === id ? "page" : null}
      onClick=${() => commandById(`panel.${id}`)?.run()}><${PhoneTab} id=${id} /></button>`,
    )}
    <${MorePanels} />
  </nav>`;
}

/** The panels that have no tab of their own; the one that is shown lends the tab its name. */
function MorePanels() {
  const others = Object.keys(PANELS).filter((id) => !PHONE_PANELS.includes(id));
  const shown = others.find((id) => id === activePanel.value);
  const items = () =>
    others.map((id) => ({
      label: panelTitle(id),
      icon: PANELS[id]?.icon ?? "box",
      run: () => commandById(`panel.${id}`)?.run(),
    }));
  return html`<${MenuButton} class=${shown ? "current" : ""} label=${t("panels.more")} value=${shown && panelTitle(shown)} items=${items}>
    ${
      shown
        ? html`<${PhoneTab} id=${shown} />`
        : html`<span class="phone-icon"><${Icon} name="dots" size=${18} /><${Mark} id="problems" /></span><span class="phone-label">${t("panels.more")}</span>`
    }<//>`;
}

/** @param {{id: string}} props */
function PhoneTab({ id }) {
  const name = id === "scene" ? t("panel.scene.short") : panelTitle(id);
  return html`<span class="phone-icon"><${Icon} name=${PANELS[id]?.icon ?? "box"} size=${18} /><${Mark} id=${id} /></span>
    <span class="phone-label">${name}</span>`;
}

/** @param {{id: string}} props how much waits there to be seen */
function Mark({ id }) {
  const badge = PANELS[id]?.badge();
  if (!badge) return null;
  return html`<span class=${`badge ${badge.tone}`} aria-label=${badge.label}>${badge.text}</span>`;
}
