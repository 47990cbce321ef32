/**
 * The 3D view: viser's page in a frame that is never reloaded, with its tools and notices over
 * it, and the frames that it is drawn in and goes with.
 */

import { html, useEffect, useRef, useSignal } from "vendor/preact.js";
import { GraphicsNotice } from "../../app/graphics.js";
import { documentAddress } from "../../lib/address.js";
import { inFrameOrder } from "../../lib/frame-tree.js";
import { t } from "../../lib/i18n.js";
import { PickBox } from "../../lib/pick-box.js";
import { remember } from "../../lib/remembered.js";
import { Icon, IconButton, MenuButton, openMenu, ProgressBar } from "../../lib/ui.js";
import { FIRST } from "../../lib/view-poses.js";
import { documentId, mayEdit, mayManage, role } from "../../model/connection.js";
import {
  displays,
  documentState,
  history,
  progress,
  robot,
  showingLastGood,
} from "../../model/document.js";
import {
  fixedFrame,
  framesNow,
  frameTrouble,
  paused,
  pauseScene,
  setFixedFrame,
} from "../../model/live-displays.js";
import { canMend, mend, openPath, setDisplay, undo, worstProblem } from "../../model/requests.js";
import { heldBack } from "../../model/source.js";
import { dialog, mouseMode, theme } from "../../model/view.js";
import {
  attachViewport,
  keepTargetFrame,
  shownView,
  targetFrame,
  targetTrouble,
  VIEWS,
  viewport,
} from "../../model/viewport.js";
import {
  canFlatten,
  isFlat,
  ownViews,
  sharedViews,
  showsCube,
  toggleFlat,
  useKind,
  useView,
} from "../../model/views.js";
import { PlaceLink } from "../parts.js";
import { MarkerHint, MarkerMenu } from "./marker-parts.js";
import { MeasureCard } from "./measure-card.js";
import { NavigationGoal } from "./navigation-goal.js";
import { ToolButtons } from "./tool-buttons.js";
import { ToolCard } from "./tool-card.js";
import { ViewCube } from "./view-cube.js";

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
      src=${id ? `${documentAddress(id)}/viser/` : "about:blank"}></iframe>
    <${Tools} />
    <${ViewCube} />
    <div class="scene-cards"><${ToolCard} /><${MeasureCard} /></div>
    <${MarkerMenu} />
    <${Cover} />
    <${MeshProgress} />
    <div class="scene-notices"><${LastGoodNotice} /><${PausedNotice} /><${NavigationGoal} /><${FollowOffer} /><${GraphicsNotice} /><${MarkerHint} /></div>
  </section>`;
}

function Tools() {
  const off = viewport.value === null;
  return html`<div class="scene-tools" role="toolbar" aria-label=${t("scene.tools")}>
    <${ToolButtons} />
    <span class="divider"></span>
    <${IconButton} icon="fit" label=${t("scene.fit")} hint=${`${t("scene.fit")} (F)`} disabled=${off}
      onClick=${() => viewport.value?.fit()} />
    <${MenuButton} label=${t("scene.views")} disabled=${off} items=${viewItems}>
      <${Icon} name="views" /><${Icon} name="chevronDown" size=${12} />
    <//>
    <${IconButton} icon="cube" class="orthographic" label=${t("scene.orthographic")} hint=${canFlatten.value ? `${t("scene.orthographic")} (5)` : t("scene.orthographic.always")}
      disabled=${off || !canFlatten.value} pressed=${isFlat.value} onClick=${toggleFlat} />
    <span class="divider"></span>
    <${LayerToggle} name="frames" icon="axes" />
    <${LayerToggle} name="names" icon="frames" />
    <span class="divider"></span>
    <${MenuButton} label=${t("scene.mouse")} disabled=${off} items=${mouseItems}>
      <${Icon} name="mouse" /><${Icon} name="chevronDown" size=${12} />
    <//>
    <${FixedFrame} />
    <${TargetFrame} />
  </div>`;
}

const KINDS = Object.keys(FIRST);

const viewItems = () => [
  ...VIEWS.map((name) => ({ label: t(`view.${name}`), run: () => viewport.value?.view(name) })),
  ...savedItems(),
  { label: t("scene.kinds"), heading: true },
  ...KINDS.map((kind) => ({
    label: kind,
    checked: shownView.value?.kind === kind,
    run: () => useKind(kind),
  })),
  { label: t("scene.settings"), heading: true },
  {
    label: t("scene.orthographic"),
    checked: isFlat.value,
    disabled: !canFlatten.value,
    run: toggleFlat,
  },
  {
    label: t("scene.cube"),
    checked: showsCube.value,
    run: () => {
      showsCube.value = !showsCube.value;
    },
  },
];

/** Those of the robot and of this browser, if there are any. */
function savedItems() {
  const views = [...sharedViews.value, ...ownViews.value];
  if (views.length === 0) return [];
  const items = views.map((view) => ({ label: view.name, run: () => useView(view) }));
  return [{ label: t("scene.saved"), heading: true }, ...items];
}

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
        mayManage.value &&
        html`<div class="buttons">
        ${
          problem?.fix &&
          canMend(problem) &&
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

/** What mends it, and the way back. @param {{problem: import("../../types/wire.d.ts").Problem | undefined}} props */
function NoticeButtons({ problem }) {
  const fix = problem?.fix?.action === "undo" ? null : problem?.fix;
  return html`${problem && fix && canMend(problem) && html`<button type="button" class="button" onClick=${() => mend(problem)}>${fix.label}</button>`}
    ${history.value.undo.length > 0 && html`<button type="button" class="button" onClick=${() => undo()}>${t("undo_edit")}</button>`}`;
}

/** Says that the view stands still, whoever paused it. */
function PausedNotice() {
  if (!paused.value) return null;
  return html`<div class="scene-hint paused" role="status"><${Icon} name="pause" size=${15} />
    <span>${t("scene.paused")}</span>
    ${mayEdit.value && html`<button type="button" class="text-button" onClick=${() => void pauseScene(false)}>${t("scene.continue")}</button>`}</div>`;
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
    viewport.value?.follow(root);
  };
  const decline = () => {
    declinedFor.value = fixed;
  };
  return html`<div class="scene-hint" role="status"><${Icon} name="info" size=${15} />
    <span>${t("follow.offer", { frame: fixed })}</span>
    <button type="button" class="text-button" onClick=${follow}>${t("follow.do", { frame: root })}</button>
    <${IconButton} icon="close" size=${14} label=${t("dismiss")} onClick=${decline} /></div>`;
}

/** In which frame everything is drawn: a box among the tools of the 3D view. */
function FixedFrame() {
  if (!robot.value) return null;
  const trouble = frameTrouble.value;
  const choices = async () => [
    { label: t("live.fixed_frame.robot"), value: "" },
    ...inFrameOrder((await framesNow()).map(({ name }) => name)),
  ];
  return html`<span class="divider"></span>
    ${trouble && html`<${Trouble} trouble=${trouble} />`}
    <span class="fixed-frame-label" aria-hidden="true">${t("live.fixed_frame.label")}</span>
    <${PickBox} class="fixed-frame" label=${t("live.fixed_frame")} text=${fixedFrame.value} placeholder=${t("live.fixed_frame.placeholder")}
      disabled=${!mayEdit.value} choices=${choices} onWrite=${(/** @type {string} */ frame) => void setFixedFrame(frame)} />`;
}

/** Why nothing can be drawn there; one click goes back. @param {{trouble: string}} props */
function Trouble({ trouble }) {
  if (!mayEdit.value)
    return html`<span class="frame-trouble" role="img" aria-label=${trouble} title=${trouble}><${Icon} name="alert" size=${15} /></span>`;
  return html`<${IconButton} class="frame-trouble" icon="alert" size=${15} label=${`${trouble} ${t("live.fixed_frame.mend")}`}
    onClick=${() => void setFixedFrame("")} />`;
}

/** With which frame the camera goes, in this browser: a menu among the tools of the 3D view. */
function TargetFrame() {
  const menu = useRef(/** @type {import("../../lib/ui.js").MenuHandle | null} */ (null));
  useEffect(() => () => menu.current?.close(), []);
  useEffect(keepTargetFrame, []);
  if (!robot.value) return null;
  const [frame, trouble] = [targetFrame.value, targetTrouble.value];
  const label = frame ? t("live.target_frame.with", { frame }) : t("live.target_frame");
  /** @param {{currentTarget: EventTarget | null}} event */
  const open = async ({ currentTarget }) => {
    const button = /** @type {HTMLElement} */ (currentTarget);
    if (button.getAttribute("aria-expanded") === "true") return menu.current?.close();
    const items = itemsOf(inFrameOrder((await framesNow()).map(({ name }) => name)));
    if (button.isConnected) menu.current = openMenu(button, label, items);
    return undefined;
  };
  return html`<button type="button" class=${`icon-button target-frame ${frame ? "on" : ""}`} aria-label=${label} title=${trouble || label}
    aria-haspopup="menu" aria-expanded="false" onClick=${open}>
    <${Icon} name=${trouble ? "alert" : "target"} />${frame && html`<span>${frame}</span>`}<${Icon} name="chevronDown" size=${12} />
  </button>`;
}

/** @param {readonly string[]} frames */
function itemsOf(frames) {
  const now = targetFrame.value;
  const names = now === "" || frames.includes(now) ? frames : [now, ...frames];
  const choices = [{ label: t("live.target_frame.none"), value: "" }].concat(
    names.map((name) => ({ label: name, value: name })),
  );
  return choices.map(({ label, value }) => ({
    label,
    checked: value === now,
    run: () => {
      viewport.value?.follow(value);
    },
  }));
}
