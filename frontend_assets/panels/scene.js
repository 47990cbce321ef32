/** The 3D view: viser's page in a frame that is never reloaded, with its tools and notices over it. */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { GraphicsNotice } from "../app/graphics.js";
import { PlaceLink } from "../app/place-link.js";
import { commandById } from "../lib/commands.js";
import { t } from "../lib/i18n.js";
import { remember } from "../lib/remembered.js";
import { Icon, IconButton, MenuButton, ProgressBar } from "../lib/ui.js";
import { documentId, mayEdit, role } from "../model/connection.js";
import {
  displays,
  documentState,
  history,
  progress,
  robot,
  showingLastGood,
} from "../model/document.js";
import { fixedFrame, frameTrouble } from "../model/live-displays.js";
import { measuring } from "../model/measuring.js";
import { mend, openPath, setDisplay, undo, worstProblem } from "../model/requests.js";
import { heldBack } from "../model/source.js";
import { dialog, mouseMode, theme } from "../model/view.js";
import { attachViewport, targetFrame, VIEWS, viewport } from "../model/viewport.js";
import { FixedFrame } from "./fixed-frame.js";
import { MeasureCard } from "./measure-card.js";
import { TargetFrame } from "./target-frame.js";

/** Whether the 3D view is part of the layout: index.html then has its client fetched at once. */
const SHOWN = "scene.shown";

export function ScenePanel() {
  const frame = useRef(/** @type {HTMLIFrameElement | null} */ (null));
  const id = documentId.value;
  useEffect(() => (frame.current ? attachViewport(frame.current) : undefined), []);
  useEffect(() => {
    remember(SHOWN, true);
    return () => remember(SHOWN, false);
  }, []);
  return html`<section class="scene" aria-label=${t("panel.scene")}>
    <iframe ref=${frame} title=${t("panel.scene")} class=${theme.value}
      src=${id ? `/d/${encodeURIComponent(id)}/viser/` : "about:blank"}></iframe>
    <${Tools} />
    <${MeasureCard} />
    <${Cover} />
    <${MeshProgress} />
    <div class="scene-notices"><${LastGoodNotice} /><${FollowOffer} /><${GraphicsNotice} /></div>
  </section>`;
}

function Tools() {
  const off = viewport.value === null;
  return html`<div class="scene-tools" role="toolbar" aria-label=${t("scene.tools")}>
    <${IconButton} icon="fit" label=${t("scene.fit")} hint=${`${t("scene.fit")} (F)`} disabled=${off}
      onClick=${() => viewport.value?.fit()} />
    <${MenuButton} label=${t("scene.views")} disabled=${off} items=${viewItems}>
      <${Icon} name="views" /><${Icon} name="chevronDown" size=${12} />
    <//>
    <span class="divider"></span>
    <${LayerToggle} name="frames" icon="axes" />
    <${LayerToggle} name="names" icon="frames" />
    <span class="divider"></span>
    <${IconButton} icon="measure" label=${t("command.measure")} hint=${`${t("command.measure")} (M)`} disabled=${off || !robot.value}
      pressed=${measuring.value} onClick=${() => commandById("measure")?.run()} />
    <span class="divider"></span>
    <${MenuButton} label=${t("scene.mouse")} disabled=${off} items=${mouseItems}>
      <${Icon} name="mouse" /><${Icon} name="chevronDown" size=${12} />
    <//>
    <${FixedFrame} />
    <${TargetFrame} />
  </div>`;
}

const viewItems = () =>
  VIEWS.map((name) => ({ label: t(`view.${name}`), run: () => viewport.value?.view(name) }));

const mouseItems = () =>
  /** @type {const} */ (["rviz", "trackpad"]).map((mode) => ({
    label: t(`mouse.${mode}`),
    hint: t(`mouse.${mode}.hint`),
    checked: mouseMode.value === mode,
    run: () => {
      mouseMode.value = mode;
    },
  }));

/** @param {{name: string, icon: string}} props a layer that all who look at the robot share */
function LayerToggle({ name, icon }) {
  const on = displays.value.robot?.[name] === true;
  return html`<${IconButton} icon=${icon} label=${t(`display.robot.${name}`)} pressed=${on}
    disabled=${!mayEdit.value || !displays.value.robot} onClick=${() => setDisplay("robot", name, !on)} />`;
}

/** Before there is a robot: what is going on, or what went wrong and what to do. */
function Cover() {
  const phase = documentState.value?.phase;
  if (documentId.value === "") return html`<${Welcome} />`;
  if (phase === "failed") return html`<${Failed} />`;
  if (robot.value) return null;
  const work = progress.value.get("expand") ?? progress.value.get("index");
  const file = documentState.value?.title ?? "";
  return html`<div class="scene-cover" role="status">
    <div class="message-card">
      <h2>${file ? t("opening.file", { file }) : t("opening")}</h2>
      <p>${work?.label ?? t("opening.hint")}</p>
      <${ProgressBar} label=${t("opening")} done=${work?.done ?? 0} total=${work?.total ?? 0} />
    </div>
  </div>`;
}

function Welcome() {
  const open = () => {
    dialog.value = { kind: "open" };
  };
  return html`<div class="scene-cover">
    <div class="message-card">
      <h2>${t("welcome")}</h2>
      <p>${role.value === "presenter" ? t("welcome.hint") : t("welcome.viewer")}</p>
      ${
        role.value === "presenter" &&
        html`<button type="button" class="button primary" onClick=${open}>
        <${Icon} name="open" />${t("command.open")}</button>`
      }
    </div>
  </div>`;
}

function Failed() {
  const problem = worstProblem();
  const state = documentState.value;
  const open = () => {
    dialog.value = { kind: "open" };
  };
  const again = () => state && openPath(state.path, { ...state.arguments });
  return html`<div class="scene-cover">
    <div class="message-card bad" role="alert">
      <h2><${Icon} name="error" size=${20} />${t("failed", { file: state?.title ?? "" })}</h2>
      <p>${problem?.sentence ?? t("failed.unknown")}</p>
      ${problem?.place && html`<p><${PlaceLink} place=${problem.place} /></p>`}
      ${
        mayEdit.value &&
        html`<div class="buttons">
        ${
          problem?.fix &&
          html`<button type="button" class="button primary"
          onClick=${() => mend(problem)}>${problem.fix.label}</button>`
        }
        <button type="button" class="button" onClick=${again}><${Icon} name="reload" />${t("try_again")}</button>
        <button type="button" class="button" onClick=${open}><${Icon} name="open" />${t("open.another")}</button>
      </div>`
      }
    </div>
  </div>`;
}

function MeshProgress() {
  const work = progress.value.get("meshes");
  if (!work) return null;
  return html`<div class="mesh-progress" role="status">
    <span>${work.label || t("meshes")}</span>
    <span class="numbers">${work.total > 0 ? `${work.done} / ${work.total}` : ""}</span>
    <${ProgressBar} label=${t("meshes")} done=${work.done} total=${work.total} />
  </div>`;
}

function LastGoodNotice() {
  if (!showingLastGood.value || heldBack.value) return null;
  const problem = worstProblem();
  return html`<div class="last-good" role="alert">
    <${Icon} name="error" size=${18} />
    <p><strong>${t("last_good")}</strong> ${problem?.sentence} <${PlaceLink} place=${problem?.place} /></p>
    ${mayEdit.value && html`<${NoticeButtons} problem=${problem} />`}
  </div>`;
}

/** What mends it, and the way back. @param {{problem: import("../types/wire.d.ts").Problem | undefined}} props */
function NoticeButtons({ problem }) {
  const fix = problem?.fix?.action === "undo" ? null : problem?.fix;
  return html`${problem && fix && html`<button type="button" class="button" onClick=${() => mend(problem)}>${fix.label}</button>`}
    ${history.value.undo.length > 0 && html`<button type="button" class="button" onClick=${() => undo()}>${t("undo_edit")}</button>`}`;
}

/** Offers to follow the robot once the view is fixed to a frame in which it drives away. */
function FollowOffer() {
  const declinedFor = useSignal("");
  const fixed = fixedFrame.value;
  const root = robot.value?.root ?? "";
  const isOfRobot = robot.value?.links.some(({ name }) => name === fixed) ?? false;
  const isFollowing = targetFrame.value !== "";
  if (!fixed || !root || isOfRobot || isFollowing || frameTrouble.value) return null;
  if (declinedFor.value === fixed) return null;
  const follow = () => {
    targetFrame.value = root;
  };
  const decline = () => {
    declinedFor.value = fixed;
  };
  return html`<div class="scene-hint" role="status"><${Icon} name="info" size=${15} />
    <span>${t("follow.offer", { frame: fixed })}</span>
    <button type="button" class="text-button" onClick=${follow}>${t("follow.do", { frame: root })}</button>
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${decline} /></div>`;
}
