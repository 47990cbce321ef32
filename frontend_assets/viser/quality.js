/** @import { Door } from "./door.js" */
/** @import { Message, Renderer } from "./viser.d.ts" */

/** Fewer pictures a second than this, for so long, is slow. */
const SLOW_HZ = 20;
const SLOW_FOR_MS = 3000;
/** Where pictures are limited, so many of them are expected: those of the screen come in between. */
const OF_LIMIT = 0.6;
/** Who asks for the next picture as soon as this after one keeps the picture moving. */
const AT_ONCE_MS = 60;
/** After a longer pause than this nothing moved: the tab was hidden, or the machine slept. */
const PAUSE_MS = 1500;
/** Shaders and meshes come first; what they cost says little about what follows. */
const WARM_UP_MS = 5000;

/** Whether this browser's pictures are drawn lightly: `early.js` decides, and a slow machine later. */
export const isLight = () => document.documentElement.dataset.graphics === "light";

/**
 * How much this browser draws, by how fast it is. Light means no shadows, no smooth edges while the
 * picture moves, one pixel of the picture for one of the page, and a plain sky for the light of a
 * street. The server and all others who look know nothing of it.
 */
export class Quality {
  #door;
  #onSlow;
  #pace = new Pace();

  /** @param {Door} door @param {(hz: number) => void} onSlow pictures a second, told once */
  constructor(door, onSlow) {
    this.#door = door;
    this.#onSlow = onSlow;
    door.onMessage((message) => this.#takeShadow(message));
    door.onRedraw(() => this.#pace.asked(performance.now()));
    door.onPicture(
      () => undefined,
      () => this.#drawn(),
    );
    const begin = () => this.#pace.begin(performance.now() + WARM_UP_MS);
    door.ready.then(begin);
    // A hidden tab draws nothing, and catches up when it is seen again.
    document.addEventListener("visibilitychange", begin);
  }

  /** Fewer than are drawn at most are slow only if they are few of those. @param {number} hz 0: no limit */
  setLimit(hz) {
    this.#pace.slowBelow_hz = hz > 0 ? Math.min(SLOW_HZ, hz * OF_LIMIT) : SLOW_HZ;
  }

  /** What the page says of it. */
  state() {
    const { graphics = "full", gl = "hardware", renderer = "" } = document.documentElement.dataset;
    return { light: graphics === "light", software: gl === "software", renderer };
  }

  /** Draw lightly from now on; smooth edges only go when the page is loaded anew. */
  lighten() {
    if (isLight()) return;
    document.documentElement.dataset.graphics = "light";
    this.#door.inject({ type: "EnableLightsMessage", enabled: true, cast_shadow: false });
    this.#door.redraw();
  }

  /** @param {Message} message */
  #takeShadow(message) {
    if (message.type === "EnableLightsMessage" && isLight()) message.cast_shadow = false;
  }

  #drawn() {
    const hz = this.#pace.drawn(performance.now());
    if (hz === null || document.hidden) return;
    this.#onSlow(hz);
  }
}

/** Counts pictures while one asks for the next: a picture that rests has no pace. */
export class Pace {
  #from = Number.POSITIVE_INFINITY;
  #last = 0;
  #pictures = 0;
  /** Whether the next picture was asked for as soon as the last was there. */
  #moving = false;
  #isTold = false;
  slowBelow_hz = SLOW_HZ;

  /** Count from a time on. @param {number} now_ms */
  begin(now_ms) {
    this.#restart(now_ms);
  }

  /** @param {number} now_ms somebody asks for a picture */
  asked(now_ms) {
    if (now_ms - this.#last <= AT_ONCE_MS) this.#moving = true;
  }

  /** @param {number} now_ms a picture is there @returns {number | null} pictures a second, once they were too few for long */
  drawn(now_ms) {
    if (this.#isTold || now_ms < this.#from) return null;
    const rested = !this.#moving || now_ms - this.#last > PAUSE_MS;
    this.#moving = false;
    this.#last = now_ms;
    if (rested) {
      this.#restart(now_ms);
      return null;
    }
    this.#pictures += 1;
    return this.#judge(now_ms);
  }

  /** @param {number} now_ms @returns {number | null} */
  #judge(now_ms) {
    const lasted_ms = now_ms - this.#from;
    if (lasted_ms < SLOW_FOR_MS) return null;
    const hz = (this.#pictures * 1000) / lasted_ms;
    this.#restart(now_ms);
    if (hz >= this.slowBelow_hz) return null;
    this.#isTold = true;
    return hz;
  }

  /** @param {number} from_ms */
  #restart(from_ms) {
    this.#from = from_ms;
    this.#pictures = 0;
  }
}

const REST_MS = 350;
const FINER = 2;

/**
 * Drawn lightly, a moving picture has one sample a pixel; the picture that comes to rest
 * is drawn once more with four. Not when the address fixed the pixels of a picture (`early.js`).
 */
export class Still {
  #door;
  /** @type {Renderer | null} */
  #renderer = null;
  /** Pixels of the screen for one of the page, while the picture moves; null: it does. @type {number | null} */
  #coarse = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #rest;

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    if (!isLight()) return;
    if (document.documentElement.dataset.pixels === "fixed") return;
    door.onPicture((renderer) => {
      this.#renderer = renderer;
      this.#wait();
    });
    door.onRedraw(() => this.#move());
    for (const type of ["pointerdown", "wheel", "resize"])
      addEventListener(type, () => this.#move(), { capture: true, passive: true });
  }

  /** The picture is about to change. */
  #move() {
    this.#wait();
    if (this.#coarse === null || !this.#renderer) return;
    this.#renderer.setPixelRatio(this.#coarse);
    this.#coarse = null;
    this.#door.redraw();
  }

  #wait() {
    if (this.#coarse !== null) return;
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => requestAnimationFrame(() => this.#refine()), REST_MS);
  }

  #refine() {
    const { scene, camera } = this.#door.mutable ?? {};
    if (!this.#renderer || !scene || !camera || this.#coarse !== null) return;
    this.#coarse = this.#renderer.getPixelRatio();
    this.#renderer.setPixelRatio(this.#coarse * FINER);
    this.#renderer.render(scene, camera);
  }
}
