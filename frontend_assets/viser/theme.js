/** @import { Door } from "./door.js" */
/** @import { Material, Message } from "./viser.d.ts" */
import { Plates } from "./plates.js";
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
