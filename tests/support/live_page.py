"""viser's page with what displays draw, seen from straight above, whose pixels a test reads."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from playwright.sync_api import ConsoleMessage, Page

    from tests.support.scene_server import SceneServer

WIDTH, HEIGHT = 720, 600
_PATIENCE_MS = 90_000
_POLL_MS = 30
_HELPERS = """() => {
  window.placeOf = (x, y, z) => {
    const { camera, canvas, nodeRefFromName } = __viserMutable;
    const root = nodeRefFromName["/live"];
    root.updateWorldMatrix(true, false);
    const place = camera.position.clone().set(x, y, z).applyMatrix4(root.matrixWorld);
    const seen = place.project(camera);
    return [((seen.x + 1) / 2) * canvas.width, ((1 - seen.y) / 2) * canvas.height];
  };
  window.hasPicture = (name) => {
    let map;
    __viserMutable.nodeRefFromName[name]?.traverse((object) => { map ??= object.material?.map; });
    return Boolean(map?.image);
  };
  const drawn = async (count) => {
    const { render } = __viserTestpoints.rendererInfo;
    const wanted = render.frame + count;
    while (render.frame < wanted) {
      __viserMutable.requestRender();
      await new Promise(requestAnimationFrame);
    }
  };
  const pixels = () => {
    const { canvas } = __viserMutable;
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
    copy.drawImage(canvas, 0, 0);
    return copy.getImageData(0, 0, canvas.width, canvas.height);
  };
  const areSame = (one, other) => {
    const [before, after] = [one, other].map(({ data }) => new Uint32Array(data.buffer));
    return before.length === after.length && before.every((pixel, at) => pixel === after[at]);
  };
  window.pictureThatStands = async () => {
    let last = pixels();
    for (let left = 60; left; left -= 1) {
      await drawn(2);
      const now = pixels();
      if (areSame(last, now)) break;
      last = now;
    }
    let text = "";
    for (let at = 0; at < last.data.length; at += 32768)
      text += String.fromCharCode(...last.data.subarray(at, at + 32768));
    return [last.width, last.height, btoa(text)];
  };
}"""


class LivePage:
    """The page of `server`; `picture` is what it showed when it was last taken."""

    def __init__(self, page: Page, server: SceneServer) -> None:
        self.page, self.server = page, server
        self.errors: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._hear)
        page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
        page.emulate_media(reduced_motion="reduce")

    def open(self) -> LivePage:
        """Load the page and wait until it can be asked."""
        self.page.goto(self.server.url + "?fixedDpr=1")
        self.until("window.__viserMutable?.nodeRefFromName['/live']")
        self.until("window.studio3d?.connected")
        self.page.evaluate(_HELPERS)
        return self

    def _hear(self, said: ConsoleMessage) -> None:
        if said.type == "error":
            self.errors.append(said.text)

    def until(self, condition: str) -> None:
        """Wait until a JavaScript expression holds."""
        self.page.wait_for_function(condition, timeout=_PATIENCE_MS, polling=_POLL_MS)

    def look(self, eye: tuple[float, float, float], target: tuple[float, float, float]) -> None:
        """From there to there, m."""
        pose = {"position": list(eye), "target": list(target)}
        self.page.evaluate("(pose) => studio3d.setCamera(pose, false)", pose)

    def take(self) -> None:
        """Take the picture: of two that follow each other the second, when they are the same."""
        width, height, text = self.page.evaluate("pictureThatStands()")
        raw = np.frombuffer(base64.b64decode(text), np.uint8)
        self.picture: NDArray[np.uint8] = raw.reshape(height, width, 4)

    def rgba(self, x: float, y: float, z: float = 0.0) -> list[int]:
        """The pixel of a place in the fixed frame, not premultiplied."""
        column, row = self.place(x, y, z)
        return self.picture[row, column].tolist()

    def around(self, x: float, y: float, reach_px: int) -> NDArray[np.uint8]:
        """Pixels around a place, shape (rows, columns, 4)."""
        column, row = self.place(x, y, 0.0)
        rows = slice(max(row - reach_px, 0), row + reach_px + 1)
        return self.picture[rows, max(column - reach_px, 0) : column + reach_px + 1]

    def place(self, x: float, y: float, z: float = 0.0) -> tuple[int, int]:
        """Column and row of the pixel of a place."""
        found: Any = self.page.evaluate("([x, y, z]) => placeOf(x, y, z)", [x, y, z])
        return round(found[0] - 0.5), round(found[1] - 0.5)
