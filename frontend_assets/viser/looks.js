/** @import { Door } from "./door.js" */
/** @import { Theme } from "./theme.js" */
/** @import { Color, Material, Object3D } from "./viser.d.ts" */
import { Outline } from "./outline.js";
import { RobotView } from "./robot.js";

const HOVER = { tint: 0.3, glow: 0.2 };
const CHANGED = { tint: 0.5, glow: 0.35 };
const MOVED = { tint: 0.22, glow: 0.14 };
const NONE = { tint: 0, glow: 0 };
/** How much faster than the accent comes the own hue goes. */
const PALER = 1.5;

/**
 * What this browser alone sees differently: links hidden, see-through, hovered, outlined or lit.
 * Materials are exchanged for the time of one picture, so that nothing that viser or the server
 * does in between can be in the way, and no reload can lose it.
 */
export class Looks {
  /** @type {string | null} */
  hovered = null;
  /** @type {Map<string, number>} */
  #opacity = new Map();
  /** Links that a property shapes, and how much they light up. @type {Map<string, typeof NONE>} */
  #lit = new Map();
  /** @type {Set<string>} */
  #hidden = new Set();
  /** @type {WeakMap<Material, Material>} */
  #twins = new WeakMap();
  /** @type {[Object3D, Material | Material[]][]} */
  #exchanged = [];
  #door;
  #robot;
  #theme;
  #outline;

  /** @param {Door} door @param {RobotView} robot @param {Theme} theme */
  constructor(door, robot, theme) {
    this.#door = door;
    this.#robot = robot;
    this.#theme = theme;
    this.#outline = new Outline(door, robot, theme);
    door.onMessage((message) => this.#hideAnew(message));
    door.onPicture(
      () => this.#dress(),
      () => this.#undress(),
    );
  }

  /** @param {string} link @param {boolean} visible */
  setVisible(link, visible) {
    if (visible) this.#hidden.delete(link);
    else this.#hidden.add(link);
    this.#door.inject(visibility(link, visible));
  }

  /** @param {string} link @param {number} opacity */
  setOpacity(link, opacity) {
    if (opacity >= 1) this.#opacity.delete(link);
    else this.#opacity.set(link, Math.max(0, opacity));
    this.#door.redraw();
  }

  /** @param {string | null} link */
  setHovered(link) {
    if (link === this.hovered) return;
    this.hovered = link;
    this.#door.redraw();
  }

  /** @param {string | null} link */
  setSelected(link) {
    if (link === this.#outline.link) return;
    this.#outline.link = link;
    this.#door.redraw();
  }

  /** @param {readonly string[]} changed @param {readonly string[]} moved */
  setLit(changed, moved) {
    if (this.#lit.size + changed.length + moved.length === 0) return;
    this.#lit = new Map(moved.map((link) => [link, MOVED]));
    for (const link of changed) this.#lit.set(link, CHANGED);
    this.#door.redraw();
  }

  /** A link that was made anew comes visible. @param {import("./viser.d.ts").Message} message */
  #hideAnew(message) {
    if (message.type !== "FrameMessage" || this.#hidden.size === 0) return;
    for (const link of this.#hidden) {
      if (message.name !== RobotView.nodeName(link)) continue;
      // After what the server says of it in this same batch.
      queueMicrotask(() => this.#door.inject(visibility(link, false)));
    }
  }

  #dress() {
    const links = this.#robot.opacity < 1 ? this.#robot.drawn : new Set([...this.#opacity.keys()]);
    for (const link of links) this.#dressLink(link);
    for (const link of new Set([this.hovered, ...this.#lit.keys()]))
      if (link && !links.has(link)) this.#dressLink(link);
  }

  /** @param {string} link */
  #dressLink(link) {
    const opacity = this.#robot.opacity * (this.#opacity.get(link) ?? 1);
    const shine = this.#shineOf(link);
    this.#robot.eachMesh(link, (mesh) => {
      if (!mesh.material) return;
      this.#exchanged.push([mesh, mesh.material]);
      mesh.material = Array.isArray(mesh.material)
        ? mesh.material.map((material) => this.#twin(material, opacity, shine))
        : this.#twin(mesh.material, opacity, shine);
    });
  }

  /** @param {string} link */
  #shineOf(link) {
    const lit = this.#lit.get(link) ?? NONE;
    return link === this.hovered && lit.tint < HOVER.tint ? HOVER : lit;
  }

  #undress() {
    for (const [mesh, material] of this.#exchanged) mesh.material = material;
    this.#exchanged = [];
  }

  /** @param {Material} material @param {number} opacity @param {{ tint: number, glow: number }} shine */
  #twin(material, opacity, shine) {
    let twin = this.#twins.get(material);
    if (!twin) {
      twin = material.clone();
      const made = twin;
      material.addEventListener("dispose", () => made.dispose());
      this.#twins.set(material, twin);
    }
    const wasTransparent = twin.transparent;
    twin.copy(material);
    twin.opacity = material.opacity * opacity;
    twin.transparent = material.transparent || opacity < 1;
    twin.depthWrite = twin.opacity > 0.5;
    twin.needsUpdate = wasTransparent !== twin.transparent;
    if (shine.tint > 0) this.#light(twin, shine);
    return twin;
  }

  /** @param {Material} twin @param {{ tint: number, glow: number }} shine */
  #light(twin, shine) {
    const accent = twin.color?.clone().set(this.#theme.accent);
    if (!accent) return;
    twin.color?.lerp(greyOf(twin.color), Math.min(1, PALER * shine.tint)).lerp(accent, shine.tint);
    if (!twin.emissive) return;
    twin.emissive.copy(accent);
    twin.emissiveIntensity = shine.glow;
  }
}

/** As bright, without a hue: yellow that turns blue would pass through purple. @param {Color} color @returns {Color} */
function greyOf(color) {
  const brightness = 0.2126 * color.r + 0.7152 * color.g + 0.0722 * color.b;
  return Object.assign(color.clone(), { r: brightness, g: brightness, b: brightness });
}

/** @param {string} link @param {boolean} visible */
function visibility(link, visible) {
  return {
    type: "SetSceneNodeVisibilityMessage",
    name: RobotView.nodeName(link),
    owner: "",
    visible,
  };
}
