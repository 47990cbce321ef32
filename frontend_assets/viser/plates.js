/** @import { Door } from "./door.js" */
/** @import { Material, Object3D } from "./viser.d.ts" */

/** viser draws words of many labels at once, in this order over all else. */
const FIRST_ORDER = 10_000;
const VISER_PLATE = "vec4(1.0, 1.0, 1.0, 0.85 * vAlpha)";
const VISER_INK = "vec4(0.0, 0.0, 0.0, a)";

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
    material.fragmentShader = `uniform vec3 studioPlate;\nuniform vec3 studioInk;\n${shader}`;
    Object.assign(material.uniforms, { studioPlate: this.#plate, studioInk: this.#ink });
    material.needsUpdate = true;
  }
}
