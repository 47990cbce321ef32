// Runs before viser's own script.

// viser reconnects only while its document has the focus; in a frame of our page it seldom has.
document.hasFocus = () => true;

// Where the processor draws, four samples a pixel double the time of a picture: there a picture at
// rest is drawn finer instead (still.js), and data-gl says so to the scripts that come later.
{
  const ask = HTMLCanvasElement.prototype.getContext;
  const gl = ask.call(document.createElement("canvas"), "webgl2");
  const told = gl?.getExtension("WEBGL_debug_renderer_info");
  const name = told ? String(gl.getParameter(told.UNMASKED_RENDERER_WEBGL)) : "";
  gl?.getExtension("WEBGL_lose_context")?.loseContext();
  if (/swiftshader|llvmpipe|softpipe|software|basic render/i.test(name)) {
    document.documentElement.dataset.gl = "software";
    HTMLCanvasElement.prototype.getContext = function getContext(kind, options) {
      const plain = kind === "webgl2" ? { ...options, antialias: false } : options;
      return ask.call(this, kind, plain);
    };
  }
}
