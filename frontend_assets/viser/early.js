// Runs before viser's own script.

// viser reconnects only while its document has the focus; in a frame of our page it seldom has.
document.hasFocus = () => true;

// While it is disconnected, viser asks its worker every second for a new connection, and the worker
// gives up the one that it is opening: where that takes longer it would never be connected. Here a
// connection that is being opened is waited for; after five seconds the worker gives it up by itself.
window.Worker = class extends Worker {
  #isOpening = false;

  constructor(...source) {
    super(...source);
    this.addEventListener("message", ({ data }) => {
      if (data?.type === "closed") this.#isOpening = false;
    });
  }

  postMessage(message, ...transfer) {
    if (message?.type === "retry" && this.#isOpening) return;
    if (message?.type === "retry" || message?.type === "set_server") this.#isOpening = true;
    super.postMessage(message, ...transfer);
  }
};

/** What the page around remembers, as lib/remembered.js writes it. */
const recall = (key) => {
  try {
    return JSON.parse(localStorage.getItem(`studio.${key}`) ?? "null");
  } catch {
    return null;
  }
};

// The colours of the page around, before anything is painted: a white picture would glare in the dark.
{
  const around = parent === window ? "" : parent.document.documentElement.dataset.theme;
  const chosen = around || recall("theme");
  const isLight = matchMedia("(prefers-color-scheme: light)").matches;
  const named = chosen === "light" || chosen === "dark" ? chosen : null;
  document.documentElement.dataset.theme = named ?? (isLight ? "light" : "dark");
}

// Who compares pictures wants the same pixels however busy the machine is: neither viser's fewer of
// them while it is slow, nor our finer ones at rest (still.js).
{
  const asked = new URLSearchParams(location.search);
  if (recall("pixels.fixed") === true && !asked.has("fixedDpr")) {
    asked.set("fixedDpr", "1");
    history.replaceState(null, "", `?${asked}`);
  }
  if (asked.has("fixedDpr")) document.documentElement.dataset.pixels = "fixed";
}

// How much is drawn (quality.js): as the person chose, else lightly where the processor draws or where
// pictures came too slowly before. Smooth edges are chosen once and for all when the canvas is made;
// without them a picture at rest is drawn finer instead (still.js).
{
  const ask = HTMLCanvasElement.prototype.getContext;
  const gl = ask.call(document.createElement("canvas"), "webgl2");
  const answer = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = answer ? String(gl.getParameter(answer.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  const isSoftware = /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);

  const choice = recall("graphics");
  const isWeak = isSoftware || recall("graphics.slow") === true;
  const isLight = choice === "light" || (choice !== "full" && isWeak);

  const { dataset } = document.documentElement;
  if (isSoftware) dataset.gl = "software";
  dataset.graphics = isLight ? "light" : "full";
  dataset.renderer = name;

  if (isLight) {
    HTMLCanvasElement.prototype.getContext = function getContext(kind, options) {
      const plain = kind === "webgl2" ? { ...options, antialias: false } : options;
      return ask.call(this, kind, plain);
    };
  }
  // Asked for whenever the canvas gets its size, so that a machine that proves slow gets fewer pixels.
  const real = Object.getOwnPropertyDescriptor(window, "devicePixelRatio");
  Object.defineProperty(window, "devicePixelRatio", {
    configurable: true,
    get() {
      const ratio = real?.get?.call(window) ?? 1;
      return dataset.graphics === "light" ? Math.min(ratio, 1) : ratio;
    },
    set(value) {
      real?.set?.call(window, value);
    },
  });
}
