/** @import { Door } from "./door.js" */
/** @import { Material, Message, Object3D, Scene } from "./viser.d.ts" */

import { isLight } from "./quality.js";

/** @typedef {"dark" | "light"} ThemeName */
/** @typedef {[number, number, number]} Rgb */

const GRID = "/grid";
const NEUTRAL_TONES = 7;
/** The grid ends at this many times the distance to what we look at. */
const FADE = 16;

/** @type {Record<ThemeName, { cell: Rgb, section: Rgb, accent: string, edge: string, shadow: number }>} */
const THEMES = {
  dark: { cell: [66, 75, 91], section: [88, 100, 120], accent: "#4db3ff", edge: "#ffffff", shadow: 0.6 },
  light: { cell: [150, 160, 178], section: [122, 135, 158], accent: "#1769d2", edge: "#ffffff", shadow: 0.28 },
};

const VISER_GRID = "return 1.0 - min(line, 1.0);";
/** Lines closer than a few pixels would shimmer: they go before that. */
const CALM_GRID = `
    float density = max(fwidth(r.x), fwidth(r.y));
    return (1.0 - min(line, 1.0)) * (1.0 - smoothstep(0.12, 0.5, density));`;

/** What the style sheet paints behind the scene with, the middle first. */
export const BACKGROUND = ["--view-high", "--view-mid", "--view-low"];

/** Colours of this browser: background, grid and accent. */
export class Theme {
  /** @type {ThemeName} */
  name = "dark";
  #door;
  #distance;
  #plates;
  /** @type {WeakSet<Material>} */
  #calmed = new WeakSet();
  #shadowed = true;

  /** @param {Door} door @param {() => number} distance From the eye to what it looks at, m. */
  constructor(door, distance) {
    this.#door = door;
    this.#distance = distance;
    this.#plates = new Plates(door);
    door.onMessage((message) => this.#paintGrid(message));
    door.onPicture((renderer) => {
      renderer.toneMapping = NEUTRAL_TONES;
      this.#calmGrid();
    });
    this.set(document.documentElement.dataset.theme === "light" ? "light" : "dark"); // by early.js
  }

  get accent() {
    return THEMES[this.name].accent;
  }

  /** Of a line in the accent, so that it is seen on everything. */
  get edge() {
    return THEMES[this.name].edge;
  }

  /** @param {ThemeName} name */
  set(name) {
    this.name = name;
    document.documentElement.dataset.theme = name;
    this.#plates.set(name);
    if (this.#door.node(GRID)) {
      const { cell: cell_color, section: section_color } = THEMES[name];
      const updates = { cell_color, section_color, ...this.#shadow() };
      this.#door.inject({ type: "SceneNodeUpdateMessage", name: GRID, owner: "", updates });
    }
    this.#door.redraw();
  }

  /** @param {string} colour as `#rrggbb`; empty: that of the theme */
  setBackground(colour) {
    const { style } = document.documentElement;
    for (const name of BACKGROUND) {
      if (colour === "") style.removeProperty(name);
      else style.setProperty(name, colour);
    }
  }

  /** The server sends a grid without a theme. @param {Message} message */
  #paintGrid(message) {
    if (message.name !== GRID) return;
    const props = message.props ?? message.updates;
    if (!props || !("cell_color" in props)) return;
    props.cell_color = THEMES[this.name].cell;
    props.section_color = THEMES[this.name].section;
    this.#shadowed = Number(props.shadow_opacity) > 0;
    Object.assign(props, this.#shadow());
  }

  #shadow() {
    return { shadow_opacity: this.#shadowed && !isLight() ? THEMES[this.name].shadow : 0 };
  }

  #calmGrid() {
    this.#door.node(GRID)?.traverse((object) => {
      const material = object.material;
      if (!material || Array.isArray(material) || !material.uniforms?.fadeDistance) return;
      material.uniforms.fadeDistance.value = this.#distance() * FADE;
      if (this.#calmed.has(material)) return;
      this.#calmed.add(material);
      material.fragmentShader = material.fragmentShader.replace(VISER_GRID, CALM_GRID);
      material.depthWrite = false;
      material.needsUpdate = true;
    });
  }
}

/** viser draws words of many labels at once, in this order over all else. */
const FIRST_ORDER = 10_000;
const VISER_PLATE = "vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)";
const VISER_INK = "vec4(0.0, 0.0, 0.0, a)";
/** By which words keep their size on the screen; ours holds without perspective, too. */
const VISER_DEPTH = "-(viewMatrix * vec4(labelPos, 1.0)).z";
const OUR_DEPTH = "(projectionMatrix * viewMatrix * vec4(labelPos, 1.0)).w";

/** sRGB, 0 to 1. @type {Record<"dark" | "light", { plate: number[], ink: number[] }>} */
const COLOURS = {
  dark: { plate: [0.09, 0.12, 0.17], ink: [0.91, 0.93, 0.96] },
  light: { plate: [1, 1, 1], ink: [0, 0, 0] },
};

/** Plates of labels in the colours of the theme: viser's are white, and glare where it is dark. */
export class Plates {
  #door;
  #plate = { value: COLOURS.light.plate };
  #ink = { value: COLOURS.light.ink };
  /** What all labels are drawn in. @type {Object3D | null} */
  #home = null;
  #hasLabels = false;
  /** @type {WeakSet<Material>} */
  #known = new WeakSet();

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onMessage(({ type }) => {
      this.#hasLabels ||= type === "LabelMessage";
    });
    door.onPicture(() => this.#paintAll());
  }

  /** @param {"dark" | "light"} theme */
  set(theme) {
    // All materials have these very objects.
    this.#plate.value = COLOURS[theme].plate;
    this.#ink.value = COLOURS[theme].ink;
  }

  /** There are plates from the beginning, and letters of another size whenever they are needed. */
  #paintAll() {
    if (!this.#hasLabels) return;
    if (!this.#home?.parent) this.#home = this.#findHome();
    for (const { material } of this.#home?.children ?? [])
      for (const one of [material ?? []].flat()) this.#paint(one);
  }

  /** @returns {Object3D | null} */
  #findHome() {
    /** @type {Object3D | null} */
    let found = null;
    this.#door.mutable?.scene?.traverse((object) => {
      if (object.renderOrder > FIRST_ORDER) found ??= object.parent;
    });
    return found;
  }

  /** @param {Material} material */
  #paint(material) {
    if (this.#known.has(material) || !material.isShaderMaterial) return;
    this.#known.add(material);
    const shader = material.fragmentShader
      .replace(VISER_PLATE, "vec4(studioPlate, 0.85 * vAlpha)")
      .replace(VISER_INK, "vec4(studioInk, a)");
    if (shader === material.fragmentShader) return;
    material.vertexShader = material.vertexShader.replace(VISER_DEPTH, OUR_DEPTH);
    material.fragmentShader = `uniform vec3 studioPlate;\nuniform vec3 studioInk;\n${shader}`;
    Object.assign(material.uniforms, { studioPlate: this.#plate, studioInk: this.#ink });
    material.needsUpdate = true;
  }
}

const SKY = "/sky";
const ROOT = "/robot";
const SURROUNDING_LIGHT = 1.25;
const DIRECT_LIGHT = 0.8;

/** What falls from above and from below where no surrounding is drawn. */
const HEMISPHERE = { sky_color: [255, 255, 255], ground_color: [122, 118, 112], intensity: 2.5 };

/**
 * The light of this browser: more from all around and less from above than viser gives, and shadows
 * that do not stripe what casts them. Where the processor draws, light from a picture of a street
 * costs more than everything else together: drawn lightly, a plain sky stands for it.
 */
export class Light {
  #door;
  #hasSky = false;
  /** @type {WeakSet<object>} */
  #softened = new WeakSet();

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onMessage((message) => this.#putSkyAnew(message));
    door.onPicture(() => this.#soften());
  }

  #soften() {
    const scene = this.#door.mutable?.scene;
    if (!scene) return;
    if (isLight()) {
      scene.environment = null;
      if (!this.#hasSky && this.#door.node(ROOT)) this.#putSky();
    }
    scene.environmentIntensity = SURROUNDING_LIGHT;
    this.#softenLamps(scene);
  }

  /** @param {Scene} scene */
  #softenLamps(scene) {
    for (const object of scene.children) {
      if (!object.shadow || this.#softened.has(object)) continue;
      this.#softened.add(object);
      object.intensity *= DIRECT_LIGHT;
      object.shadow.normalBias = 0.02;
      object.shadow.radius = 1.5;
    }
  }

  /** The server, which begins with the robot, does not know of the sky. @param {Message} message */
  #putSkyAnew(message) {
    if (message.name !== ROOT || message.type !== "FrameMessage") return;
    if (isLight()) queueMicrotask(() => this.#putSky());
  }

  #putSky() {
    this.#hasSky = true;
    this.#door.inject(...skyMessages());
  }
}

/** @returns {Message[]} */
function skyMessages() {
  return [
    { type: "HemisphereLightMessage", name: SKY, owner: "", virtual: false, props: { ...HEMISPHERE } },
    { type: "SetPositionMessage", name: SKY, owner: "", position: [0, 0, 1] },
  ];
}
