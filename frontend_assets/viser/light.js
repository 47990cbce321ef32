/** @import { Door } from "./door.js" */
/** @import { Message, Scene } from "./viser.d.ts" */
import { isLight } from "./quality.js";

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
