/** @import { Message, Mutable } from "./viser.d.ts" */

const POSES = new Set(["SetPositionMessage", "SetOrientationMessage"]);

/**
 * The one way into viser's page: its state, the messages that come in, and a moment before and
 * after each picture. Everything else here asks the door.
 */
export class Door {
  /** @type {Mutable | null} */
  mutable = null;
  connected = false;
  /** @type {((message: Message) => void)[]} */
  #readers = [];
  /** @type {((connected: boolean) => void)[]} */
  #watchers = [];
  /** @type {((renderer: import("./viser.d.ts").Renderer) => void)[]} */
  #before = [];
  /** @type {(() => void)[]} */
  #after = [];
  /** @type {(() => void)[]} */
  #redraws = [];
  #takesInSoon = false;
  /** Names of nodes that are frames and nothing else. @type {Set<string>} */
  #frames = new Set();
  /** Names of those of them that were given a pose since it was put into the scene. @type {Set<string>} */
  #moved = new Set();
  /** @type {(mutable: Mutable) => void} */
  #opened = () => {};

  constructor() {
    /** Settles when viser's scene stands. @type {Promise<Mutable>} */
    this.ready = new Promise((resolve) => {
      this.#opened = resolve;
    });
    const present = window.__viserMutable;
    const attach = (/** @type {Mutable} */ mutable) => this.#attach(mutable);
    Object.defineProperty(window, "__viserMutable", {
      configurable: true,
      get: () => this.mutable,
      set: attach,
    });
    if (present) attach(present);
  }

  /** Read, and change in place, each message before viser does. @param {(message: Message) => void} reader */
  onMessage(reader) {
    this.#readers.push(reader);
  }

  /** Hear of the connection to the server. @param {(connected: boolean) => void} watcher */
  onConnection(watcher) {
    this.#watchers.push(watcher);
  }

  /** @param {(renderer: import("./viser.d.ts").Renderer) => void} before @param {() => void} [after] */
  onPicture(before, after) {
    this.#before.push(before);
    if (after) this.#after.push(after);
  }

  /** Hear that somebody asks for a picture. @param {() => void} watcher */
  onRedraw(watcher) {
    this.#redraws.push(watcher);
  }

  /** Tell viser something that only this browser shall know. @param {Message[]} messages */
  inject(...messages) {
    if (!this.mutable || messages.length === 0) return;
    for (const message of messages) Array.prototype.push.call(this.mutable.messageQueue, message);
    this.#takeInSoon();
  }

  /** Draw soon. */
  redraw() {
    this.mutable?.requestRender();
  }

  /** @param {string} name @returns {import("./viser.d.ts").Object3D | undefined} */
  node(name) {
    return this.mutable?.nodeRefFromName[name];
  }

  /** @param {Mutable} mutable */
  #attach(mutable) {
    if (this.mutable === mutable) return;
    this.mutable = mutable;
    this.#tapMessages(mutable);
    this.#tapConnection(mutable);
    this.#tapPictures(mutable);
    this.#tapRedraws(mutable);
    this.#readWhatCameBefore();
    this.#opened(mutable);
  }

  /** @param {Mutable} mutable */
  #tapMessages(mutable) {
    const read = (/** @type {Message} */ message) => {
      this.#tellConnected(true);
      this.#noteFrame(message);
      for (const reader of this.#readers) reader(message);
    };
    mutable.messageQueue.forEach(read);
    const takeInSoon = () => this.#takeInSoon();
    mutable.messageQueue.push = function push(...messages) {
      messages.forEach(read);
      takeInSoon();
      return Array.prototype.push.apply(this, messages);
    };
  }

  /** @param {Message} message */
  #noteFrame({ type, name = "" }) {
    if (type === "FrameMessage") this.#frames.add(name);
    else if (type === "RemoveSceneNodeMessage") this.#frames.delete(name);
    else if (POSES.has(type) && this.#frames.has(name)) this.#moved.add(name);
  }

  /**
   * viser takes a batch in at the beginning of a picture: it has the new poses then, and what React
   * makes of the batch, such as points, is seen in the next one. Taken in as soon as it is there
   * whole, all of it is seen in the first.
   */
  #takeInSoon() {
    if (this.#takesInSoon) return;
    this.#takesInSoon = true;
    queueMicrotask(() => {
      this.#takesInSoon = false;
      this.mutable?.drainMessageQueue?.();
      this.mutable?.requestRender();
      // React makes the shapes before this, which was asked for later.
      queueMicrotask(() => this.#placeFrames());
    });
  }

  /** Frames stand where the batch says together with its shapes; viser would wait for the picture. */
  #placeFrames() {
    for (const name of this.#moved) {
      const pose = this.mutable?.nodePoseData[name];
      const node = this.node(name);
      if (!node || pose?.poseUpdateState !== "needsUpdate") continue;
      const [w, x, y, z] = pose.wxyz;
      node.quaternion.set(x, y, z, w);
      node.position.set(...pose.position);
    }
    this.#moved.clear();
  }

  /** viser marks a first batch and gives itself a way to send when it connects; when it loses the
   * connection it only replaces the way to send. @param {Mutable} mutable */
  #tapConnection(mutable) {
    let first = mutable.firstMessageBatch;
    let send = mutable.sendMessage;
    let opening = first;
    Object.defineProperty(mutable, "firstMessageBatch", {
      configurable: true,
      get: () => first,
      set: (value) => {
        first = value;
        opening = value;
      },
    });
    Object.defineProperty(mutable, "sendMessage", {
      configurable: true,
      get: () => send,
      set: (value) => {
        send = value;
        this.#tellConnected(opening);
        opening = false;
      },
    });
    if (!first) this.#tellConnected(true);
  }

  /** @param {boolean} connected */
  #tellConnected(connected) {
    if (connected === this.connected) return;
    this.connected = connected;
    for (const watcher of this.#watchers) watcher(connected);
  }

  /** @param {Mutable} mutable */
  #tapPictures(mutable) {
    const scene = mutable.scene;
    if (!scene) return;
    scene.onBeforeRender = (renderer) => {
      for (const before of this.#before) before(renderer);
    };
    scene.onAfterRender = () => {
      for (const after of this.#after) after();
    };
  }

  /** viser replaces its way to ask when its canvas stands. @param {Mutable} mutable */
  #tapRedraws(mutable) {
    let ask = mutable.requestRender;
    const askAndTell = () => {
      ask();
      for (const redraw of this.#redraws) redraw();
    };
    Object.defineProperty(mutable, "requestRender", {
      configurable: true,
      get: () => askAndTell,
      set: (value) => {
        ask = value;
      },
    });
  }

  /** The page may have drawn before the door was there. */
  #readWhatCameBefore() {
    for (const node of Object.values(window.__viserSceneTree?.getState() ?? {})) {
      if (node) for (const reader of this.#readers) reader(node.message);
    }
  }
}

/**
 * viser keeps the name of every node that was ever there, with nothing under it: of markers that come
 * under new names all day these become many. Those that are gone are forgotten after the next picture.
 */
export class Removed {
  #door;
  /** @type {Set<string>} */
  #names = new Set();

  /** @param {Door} door */
  constructor(door) {
    this.#door = door;
    door.onMessage(({ type, name }) => {
      if (type === "RemoveSceneNodeMessage" && name) this.#names.add(name);
    });
    door.onPicture(
      () => undefined,
      () => this.#forget(),
    );
  }

  #forget() {
    const nodes = this.#door.mutable?.nodeRefFromName;
    const state = window.__viserSceneTree?.getState();
    if (!nodes || !state) return;
    for (const name of this.#names) {
      if (name in state) this.#names.delete(name);
      else if (!nodes[name]) {
        delete nodes[name];
        this.#names.delete(name);
      }
    }
  }
}
