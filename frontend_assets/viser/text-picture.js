/** Of the letters in the picture: enough for words that fill a third of the window. */
export const FONT_PX = 48;
const FONT = `600 ${FONT_PX}px system-ui, sans-serif`;
const LINE = 1.25;
const MARGIN_PX = 6;
const OUTLINE_PX = 5;
const WIDEST_PX = 4096;
const LINES_MAX = 12;
const KEPT = 200;

/** @typedef {{ data: Uint8Array, width: number, height: number }} Written a PNG and its size in pixels */

/** @type {Map<string, Written>} */
const kept = new Map();

/** Words in a colour on nothing, with an edge that sets them off. @param {string} text @param {readonly number[]} rgb 0 to 255 @returns {Written} */
export function textPicture(text, rgb) {
  const key = `${rgb.join()} ${text}`;
  const found = kept.get(key) ?? write(text, rgb);
  kept.delete(key);
  kept.set(key, found);
  for (const oldest of kept.keys()) {
    if (kept.size <= KEPT) break;
    kept.delete(oldest);
  }
  return found;
}

/** @param {string} text @param {readonly number[]} rgb @returns {Written} */
function write(text, rgb) {
  const lines = text.split("\n").slice(0, LINES_MAX);
  const canvas = document.createElement("canvas");
  const paint = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  paint.font = FONT;
  const wanted = Math.max(...lines.map((line) => paint.measureText(line).width)) + 2 * MARGIN_PX;
  canvas.width = Math.ceil(Math.min(Math.max(wanted, 1), WIDEST_PX));
  canvas.height = Math.ceil(lines.length * LINE * FONT_PX + 2 * MARGIN_PX);
  Object.assign(paint, { font: FONT, textAlign: "center", textBaseline: "middle" });
  Object.assign(paint, { lineJoin: "round", lineWidth: OUTLINE_PX });
  paint.fillStyle = `rgb(${rgb.join(" ")})`;
  paint.strokeStyle = edgeOf(rgb);
  lines.forEach((line, at) => {
    const y = MARGIN_PX + (at + 0.5) * LINE * FONT_PX;
    paint.strokeText(line, canvas.width / 2, y, canvas.width - 2 * MARGIN_PX);
    paint.fillText(line, canvas.width / 2, y, canvas.width - 2 * MARGIN_PX);
  });
  return { data: bytesOf(canvas), width: canvas.width, height: canvas.height };
}

/** Dark around bright letters and bright around dark ones. @param {readonly number[]} rgb */
export function edgeOf([red = 0, green = 0, blue = 0]) {
  const brightness = (0.2126 * red + 0.7152 * green + 0.0722 * blue) / 255;
  return brightness > 0.4 ? "rgb(0 0 0 / 55%)" : "rgb(255 255 255 / 65%)";
}

/** @param {HTMLCanvasElement} canvas */
function bytesOf(canvas) {
  const encoded = canvas.toDataURL("image/png").split(",")[1] ?? "";
  return Uint8Array.from(atob(encoded), (letter) => letter.charCodeAt(0));
}
