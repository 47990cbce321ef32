"""viser's page with our script in a real browser, as a test handles it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.robot.kinematics import Kinematics
from tests.support.studio_page import ACTION_PATIENCE_MS

if TYPE_CHECKING:
    from playwright.sync_api import Frame, Page

    from studio.robot.values import Robot
    from tests.support.scene_server import SceneServer

WIDTH, HEIGHT = 640, 420
_HELPERS = """() => {
  window.heard = [];
  for (const type of ["hover", "select", "focus", "drag", "key", "connection"])
    studio3d.events.addEventListener(type, (event) => heard.push([type, event.detail]));
  window.middleOf = (node) => {
    const { camera, canvas, nodeRefFromName } = __viserMutable;
    let mesh;
    nodeRefFromName[node].traverse((object) => { if (object.isMesh) mesh ??= object; });
    mesh.updateWorldMatrix(true, false);
    mesh.geometry.computeBoundingBox();
    const { min, max } = mesh.geometry.boundingBox;
    const seen = min.clone().add(max).multiplyScalar(0.5)
      .applyMatrix4(mesh.matrixWorld).project(camera);
    return [((seen.x + 1) / 2) * canvas.clientWidth, ((1 - seen.y) / 2) * canvas.clientHeight];
  };
  window.colorAt = (x, y) => {
    const copy = document.createElement("canvas");
    const canvas = __viserMutable.canvas;
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    return [...context.getImageData(x, y, 1, 1).data];
  };
  window.placesOf = (rgb) => {
    const copy = document.createElement("canvas");
    const canvas = __viserMutable.canvas;
    [copy.width, copy.height] = [canvas.width, canvas.height];
    const context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0);
    const { data, width } = context.getImageData(0, 0, copy.width, copy.height);
    const found = [];
    for (let at = 0; at < data.length; at += 4)
      if (data.subarray(at, at + 3).join() === rgb)
        found.push([(at / 4) % width, Math.floor(at / 4 / width)]);
    return found;
  };
}"""


class ScenePage:
    """The page of `server`, or of a frame in it, with the robot told to it and drawn."""

    def __init__(self, page: Page, server: SceneServer, robot: Robot) -> None:
        self.page, self.server, self.robot = page, server, robot
        self.kinematics = Kinematics(robot)
        self.requests: list[str] = []
        self.errors: list[str] = []
        page.set_default_timeout(ACTION_PATIENCE_MS)
        page.on("request", lambda request: self.requests.append(request.url))
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.set_viewport_size({"width": WIDTH, "height": HEIGHT})
        page.emulate_media(reduced_motion="reduce")
        server.call(lambda scene: scene.set_display("grid", "shadow", False))
        self.pose({})

    def open(self, *, framed: bool = False) -> ScenePage:
        """Load the page and wait until the last link of the robot is drawn."""
        if framed:
            self.page.goto(self.server.url.replace("/d/one/viser/", "/frame"))
        else:
            self.page.goto(self.server.url + "?fixedDpr=1")
        self.frame: Frame = self.page.frames[-1]
        last = list(self.robot.links)[-1]
        self.until(f"window.__viserMutable?.nodeRefFromName['/robot/{last}/visual/0']")
        self.until("'drawn' in document.documentElement.dataset")
        self.run("(state) => studio3d.setRobot(state)", self.state())
        self.run(_HELPERS)
        self.pose({})
        return self

    def start_again(self) -> None:
        """As it was after `open`: the robot at zero, seen from the usual side, nothing heard."""
        robot = self.robot
        self.page.mouse.move(1, 1)
        self.server.call(lambda scene: (scene.show(robot, None), scene.flush()))
        self.pose({})
        self.run(
            """() => {
              studio3d.setSelection(null);
              studio3d.setCanDrag(true);
              studio3d.setLinkVisible("mast", true);
              studio3d.setTheme("dark");
              studio3d.view("iso");
            }"""
        )
        self.pictures(2)
        self.run("heard.length = 0")

    def pictures(self, count: int) -> None:
        """Wait until viser has drawn that many more pictures."""
        self.run(
            """async (count) => {
              const { render } = __viserTestpoints.rendererInfo;
              const wanted = render.frame + count;
              while (render.frame < wanted) {
                __viserMutable.requestRender();
                await new Promise(requestAnimationFrame);
              }
            }""",
            count,
        )

    def pose(self, positions: dict[str, float]) -> None:
        """Move the joints, as the engine does, and tell the page."""
        values = self.kinematics.positions_with_mimic(positions)
        poses = self.kinematics.wxyz_xyz(values)
        names, robot = self.kinematics.link_names, self.robot
        self.server.call(
            lambda scene: (
                scene.show(robot, frozenset()),
                scene.set_poses(names, poses),
                scene.flush(),
            )
        )
        if hasattr(self, "frame"):
            told = dict(zip(self.kinematics.movable, values.tolist(), strict=True))
            self.run("(positions) => studio3d.setPositions(positions)", told)

    def state(self) -> dict[str, Any]:
        """What the page is told of the robot: RobotState of the protocol."""
        joints = [
            {
                "name": joint.name,
                "type": joint.type.value,
                "parent": joint.parent,
                "child": joint.child,
                "axis": joint.axis,
                "lower": joint.limit.lower if joint.limit else None,
                "upper": joint.limit.upper if joint.limit else None,
                "mimic": joint.mimic.joint if joint.mimic else "",
                "multiplier": joint.mimic.multiplier if joint.mimic else 1.0,
            }
            for joint in self.robot.joints.values()
        ]
        links = [{"name": name} for name in self.robot.links]
        return {"root": "", "links": links, "joints": joints}

    def run(self, script: str, argument: object = None) -> Any:  # noqa: ANN401
        return self.frame.evaluate(script, argument)

    def until(self, condition: str) -> None:
        """Wait until a JavaScript expression holds."""
        self.frame.wait_for_function(condition, timeout=ACTION_PATIENCE_MS)

    def place_of(self, node: str) -> tuple[float, float]:
        """Where on screen the middle of a geometry is."""
        x, y = self.run("(node) => middleOf(node)", f"/robot/{node}")
        return x, y

    def heard(self, kind: str) -> list[Any]:
        """Details of the events of that kind so far."""
        return [detail for type_, detail in self.run("heard") if type_ == kind]

    def draw_link(self, node: str, by: tuple[float, float]) -> tuple[str, tuple[float, float]]:
        """Draw a geometry of a link by the mouse: the joint that moved, and how far on screen."""
        start = self.place_of(node)
        self.draw_mouse(start, by)
        self.page.mouse.up()
        drag = self.heard("drag")[-1]
        self.pose({drag["joint"]: drag["value"]})
        self.pictures(3)
        x, y = self.place_of(node)
        return drag["joint"], (x - start[0], y - start[1])

    def draw_mouse(self, start: tuple[float, float], by: tuple[float, float]) -> None:
        """Press, draw in a few steps, and keep the button down."""
        self.page.mouse.move(*start)
        self.page.mouse.down()
        self.page.mouse.move(start[0] + by[0], start[1] + by[1], steps=6)
