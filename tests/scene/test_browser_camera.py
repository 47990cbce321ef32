"""The camera as each of RViz's views: where it stands, what a hand does, and what it goes with."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

import pytest

from studio.rviz.views import ORTHOGRAPHIC, VIEW_KINDS
from tests.support.robots import rover
from tests.support.scene_page import HEIGHT, WIDTH, ScenePage

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser

    from tests.support.scene_server import SceneServer

pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(180)]

EMPTY = (90, 60)
"""A place of the picture where no link is."""
CAMERA = """() => {
  const { camera, nodeRefFromName } = __viserMutable;
  const back = nodeRefFromName[""].matrixWorld.clone().invert();
  const place = camera.position.clone().setFromMatrixPosition(camera.matrixWorld);
  const way = (column) => camera.position.clone()
    .setFromMatrixColumn(camera.matrixWorld, column).transformDirection(back).toArray();
  return {
    eye: place.applyMatrix4(back).toArray(),
    ahead: way(2).map((one) => -one), up: way(1),
    flat: camera.projectionMatrix.elements[11] === 0,
  };
}"""
Triple = tuple[float, float, float]
Button = Literal["left", "middle", "right"]


@pytest.fixture(scope="module")
def opened(browser: Browser, server: SceneServer) -> Iterator[ScenePage]:
    context = browser.new_context()
    yield ScenePage(context.new_page(), server, rover()).open()
    context.close()


@pytest.fixture
def view(opened: ScenePage) -> ScenePage:
    opened.run("studio3d.useView({ kind: 'Orbit', values: {} }, false)")
    opened.start_again()
    return opened


def use(view: ScenePage, kind: str, **values: float | str | bool) -> None:
    named = {name.replace("__", "/").replace("_", " "): one for name, one in values.items()}
    view.run("(view) => studio3d.useView(view, false)", {"kind": kind, "values": named})


def values(view: ScenePage) -> dict[str, Any]:
    return view.run("studio3d.getView().values")


def camera(view: ScenePage) -> dict[str, Any]:
    view.pictures(1)
    return view.run(CAMERA)


def drag(
    view: ScenePage, by: Triple | tuple[int, int], button: Button = "left", keys: str = ""
) -> None:
    mouse, keyboard = view.page.mouse, view.page.keyboard
    if keys:
        keyboard.down(keys)
    mouse.move(*EMPTY)
    mouse.down(button=button)
    mouse.move(EMPTY[0] + by[0], EMPTY[1] + by[1], steps=2)
    mouse.up(button=button)
    if keys:
        keyboard.up(keys)


def test_the_page_has_the_first_values_of_rvizs_views(view: ScenePage):
    firsts = view.run("studio3d.firstValues()")
    for kind, found in VIEW_KINDS.items():
        assert firsts[kind] == {one.name: one.default for one in found.properties}, kind


def orbit_eye(yaw: float, pitch: float, distance: float) -> Triple:
    level = distance * math.cos(pitch)
    return level * math.cos(yaw), level * math.sin(yaw), distance * math.sin(pitch)


@pytest.mark.parametrize("kind", ["Orbit", "ThirdPersonFollower"])
def test_an_orbit_stands_where_rviz_puts_it(view: ScenePage, kind: str):
    use(view, kind, Yaw=0.7, Pitch=0.4, Distance=3.0)
    seen = camera(view)
    assert seen["eye"] == pytest.approx(orbit_eye(0.7, 0.4, 3.0), abs=1e-5)
    assert seen["ahead"] == pytest.approx([-one / 3 for one in seen["eye"]], abs=1e-5)
    assert not seen["flat"]


def test_an_xy_orbit_stands_a_fifth_of_its_distance_higher(view: ScenePage):
    use(view, "XYOrbit", Yaw=0.7, Pitch=0.4, Distance=3.0)
    seen = camera(view)
    above = [one + 0.6 * up for one, up in zip(orbit_eye(0.7, 0.4, 3), seen["up"], strict=True)]
    assert seen["eye"] == pytest.approx(above, abs=1e-5)


def test_an_fps_looks_along_yaw_and_below_the_horizon_by_pitch(view: ScenePage):
    use(view, "FPS", Yaw=2.0, Pitch=0.3, Position__X=1.0, Position__Y=2.0, Position__Z=0.5)
    seen = camera(view)
    assert seen["eye"] == pytest.approx((1.0, 2.0, 0.5), abs=1e-5)
    ahead = (math.cos(2) * math.cos(0.3), math.sin(2) * math.cos(0.3), -math.sin(0.3))
    assert seen["ahead"] == pytest.approx(ahead, abs=1e-5)


def test_a_map_looks_down_without_perspective_and_with_its_scale(view: ScenePage):
    use(view, "TopDownOrtho", Scale=100.0, X=0.5, Y=-0.25, Angle=0.0)
    seen = camera(view)
    assert seen["flat"]
    assert seen["ahead"] == pytest.approx((0, 0, -1), abs=1e-5)
    assert seen["eye"][:2] == pytest.approx((0.5, -0.25), abs=1e-5)
    metre = """(at) => { const { camera, canvas, nodeRefFromName } = __viserMutable;
      const seen = camera.position.clone().set(...at)
        .applyMatrix4(nodeRefFromName[""].matrixWorld).project(camera);
      return [seen.x * canvas.clientWidth / 2, seen.y * canvas.clientHeight / 2]; }"""
    near, far = (view.run(metre, [1.5, 0.75, z]) for z in (2.0, -1.0))
    assert near == pytest.approx((100, 100), abs=0.01)
    assert far == pytest.approx(near, abs=0.01)


def test_one_aligned_with_its_frame_looks_along_its_axis_and_tilts_with_it(view: ScenePage):
    use(view, "FrameAligned", Target_Frame="upper arm")
    view.run("studio3d.setViewValue('Point towards', '+x axis')")
    turns = """() => { const node = __viserMutable.nodeRefFromName["/robot/upper%20arm"];
      const root = __viserMutable.nodeRefFromName[""].matrixWorld.clone().invert();
      const way = (column) => node.position.clone()
        .setFromMatrixColumn(node.matrixWorld, column).transformDirection(root).toArray();
      return { ahead: way(0), up: way(2) }; }"""
    joint = next(one.name for one in view.robot.joints.values() if one.child == "upper arm")
    for angle in (0.0, 0.5):
        view.pose({joint: angle})
        view.pictures(2)
        seen, frame = camera(view), view.run(turns)
        assert seen["ahead"] == pytest.approx(frame["ahead"], abs=1e-4)
        assert seen["up"] == pytest.approx(frame["up"], abs=1e-4)


def test_a_view_goes_with_the_place_of_its_frame_and_stays_when_that_is_chosen(view: ScenePage):
    before = camera(view)
    view.run("studio3d.setViewValue('Target Frame', 'upper arm')")
    assert camera(view)["eye"] == pytest.approx(before["eye"], abs=1e-5)
    joint = next(one.name for one in view.robot.joints.values() if one.child == "upper arm")
    where = """() => { const node = __viserMutable.nodeRefFromName["/robot/upper%20arm"];
      const root = __viserMutable.nodeRefFromName[""].matrixWorld.clone().invert();
      return node.position.clone().setFromMatrixPosition(node.matrixWorld).applyMatrix4(root)
        .toArray(); }"""
    stood = view.run(where)
    parent = next(one for one in view.robot.joints.values() if one.name == joint).parent
    moving = next((one.name for one in view.robot.joints.values() if one.child == parent), joint)
    view.pose({moving: 0.6, joint: 0.6})
    view.pictures(2)
    way = [now - then for now, then in zip(view.run(where), stood, strict=True)]
    went = [a - b for a, b in zip(camera(view)["eye"], before["eye"], strict=True)]
    assert went == pytest.approx(way, abs=1e-4)
    view.run("studio3d.setViewValue('Target Frame', '<Fixed Frame>')")


def test_a_follower_turns_with_its_frame_and_stays_upright(view: ScenePage):
    use(view, "ThirdPersonFollower", Yaw=0.4, Pitch=0.3, Distance=2.0)
    view.run("studio3d.setViewValue('Target Frame', 'upper arm')")
    before, (angle, lift) = camera(view), (0.6, 0.5)
    view.pose({"turn": angle, "lift": lift})
    view.pictures(2)
    after, (x, y, z) = camera(view), before["ahead"]
    turned = (
        math.cos(angle) * x - math.sin(angle) * y,
        math.sin(angle) * x + math.cos(angle) * y,
    )
    assert after["ahead"] == pytest.approx((*turned, z), abs=1e-4)
    assert math.dist(after["eye"], before["eye"]) > 0.5  # around its frame
    view.run("studio3d.setViewValue('Target Frame', '<Fixed Frame>')")


def test_the_mouse_does_to_an_orbit_what_it_does_in_rviz(view: ScenePage):
    use(view, "Orbit", Yaw=1.0, Pitch=0.5, Distance=4.0)
    drag(view, (20, 10))
    assert values(view) == pytest.approx({**values(view), "Yaw": 0.9, "Pitch": 0.55})
    drag(view, (0, 10), "right")
    assert values(view)["Distance"] == pytest.approx(4 * 1.05**2)  # in two steps
    view.page.mouse.wheel(0, -100)
    view.until("Math.abs(studio3d.getView().values.Distance - 4 * 1.05 ** 2 * 0.88) < 1e-6")
    use(view, "Orbit", Yaw=0.0, Pitch=0.0, Distance=4.0)
    metre_px = HEIGHT / (8 * math.tan(math.pi / 8))
    ways: list[tuple[Button, str]] = [("middle", ""), ("left", "Shift")]
    for button, keys in ways:
        use(view, "Orbit", Yaw=0.0, Pitch=0.0, Distance=4.0)
        drag(view, (30, 12), button, keys)
        assert values(view)["Focal Point/Y"] == pytest.approx(-30 / metre_px)
        assert values(view)["Focal Point/Z"] == pytest.approx(12 / metre_px)
    use(view, "Orbit", Yaw=0.0, Pitch=0.0, Distance=4.0)
    drag(view, (0, 10), "right", "Shift")
    assert values(view)["Focal Point/X"] == pytest.approx(0.4)


def test_with_a_trackpad_right_moves_too(view: ScenePage):
    view.run("studio3d.setMouse('trackpad')")
    use(view, "Orbit", Yaw=0.0, Pitch=0.0, Distance=4.0)
    drag(view, (30, 0), "right")
    view.run("studio3d.setMouse('rviz')")
    assert values(view)["Distance"] == 4.0
    assert values(view)["Focal Point/Y"] < -0.1


def test_the_mouse_walks_and_maps_as_in_rviz(view: ScenePage):
    use(view, "FPS", Yaw=0.0, Pitch=0.0, Position__X=0.0, Position__Y=0.0, Position__Z=1.0)
    drag(view, (-20, 10))
    assert values(view) == pytest.approx({**values(view), "Yaw": 0.1, "Pitch": 0.05})
    use(view, "FPS", Yaw=0.0, Pitch=0.0, Position__X=0.0, Position__Y=0.0, Position__Z=1.0)
    drag(view, (0, -10), "right")
    assert values(view)["Position/X"] == pytest.approx(1.0)
    use(view, "TopDownOrtho", Scale=100.0)
    drag(view, (20, 0))
    assert values(view)["Angle"] == pytest.approx(0.1)
    use(view, "TopDownOrtho", Scale=100.0)
    drag(view, (50, 20), "middle")
    assert (values(view)["X"], values(view)["Y"]) == pytest.approx((-0.5, 0.2))


def test_two_fingers_zoom_and_one_turns(view: ScenePage):
    use(view, "Orbit", Yaw=1.0, Pitch=0.5, Distance=4.0)
    touches: Any = view.page.context.new_cdp_session(view.page)

    def touch(kind: str, *places: tuple[int, int]) -> None:
        points = [{"x": x, "y": y, "id": at} for at, (x, y) in enumerate(places)]
        touches.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    touch("touchStart", (90, 60))
    touch("touchMove", (110, 60))
    view.until("Math.abs(studio3d.getView().values.Yaw - 0.9) < 1e-6")
    touch("touchEnd")
    touch("touchStart", (60, 60))
    touch("touchStart", (60, 60), (160, 60))
    touch("touchMove", (10, 60), (210, 60))
    view.until("Math.abs(studio3d.getView().values.Distance - 2) < 1e-6")
    touch("touchEnd")

    # What a tool had of the first finger is the camera's from where that finger is.
    view.run("studio3d.setTool('Select')")
    use(view, "Orbit", Yaw=1.0, Pitch=0.5, Distance=4.0)
    touch("touchStart", (90, 60))
    touch("touchMove", (60, 60))
    touch("touchStart", (60, 60), (160, 60))
    touch("touchMove", (10, 60), (210, 60))
    view.until("Math.abs(studio3d.getView().values.Distance - 2) < 1e-6")
    touch("touchEnd")
    view.run("studio3d.setTool('Interact')")


def test_another_kind_shows_the_same(view: ScenePage):
    use(view, "Orbit", Yaw=0.6, Pitch=0.5, Distance=3.0, Focal_Point__Z=0.2)
    before = camera(view)
    for kind in ("FPS", "XYOrbit", "ThirdPersonFollower", "FrameAligned", "Orbit"):
        view.run("(kind) => studio3d.setViewKind(kind)", kind)
        seen = camera(view)
        for part in ("eye", "ahead", "up"):
            assert seen[part] == pytest.approx(before[part], abs=1e-4), (kind, part)
    view.run("studio3d.setViewKind('TopDownOrtho')")
    assert camera(view)["ahead"] == pytest.approx((0, 0, -1), abs=1e-5)


def test_without_perspective_what_is_seen_under_the_mouse_is_what_is_picked(view: ScenePage):
    view.run("(name) => studio3d.setViewValue(name, true)", ORTHOGRAPHIC)
    view.run("studio3d.fit()")
    view.pictures(3)
    assert camera(view)["flat"]
    for node, link in (
        ("upper%20arm/visual/0", "upper arm"),
        ("camera/visual/0", "camera"),
        ("wheel_1/visual/1", "wheel_1"),
    ):
        place = view.place_of(node)
        assert view.run("([x, y]) => studio3d.linkAt(x, y)", place) == link
    x, y = view.place_of("upper%20arm/visual/0")
    view.until(f"colorAt({x}, {y})[3] === 255")
    red, green, blue, _ = view.run(f"colorAt({x}, {y})")
    assert red > green > blue  # amber
    assert view.run("studio3d.linkAt(5, 5)") is None


def test_a_joint_is_dragged_without_perspective_as_far_as_the_mouse(view: ScenePage):
    view.run("(name) => studio3d.setViewValue(name, true)", ORTHOGRAPHIC)
    view.run("studio3d.view('front')")
    view.pictures(2)
    joint, (went, _) = view.draw_link("finger%2Fleft/visual/0", (9, 0))
    assert joint == "grip"
    assert went == pytest.approx(9, abs=1.0)


def test_f_turns_to_what_is_under_the_mouse_and_fits_where_nothing_is(view: ScenePage):
    place = view.place_of("camera/visual/0")
    eye = camera(view)["eye"]
    view.page.mouse.move(*place)
    view.until("studio3d.isPointing()")
    assert view.run("studio3d.lookAtPointed()")
    assert camera(view)["eye"] == pytest.approx(eye, abs=1e-3)
    assert view.place_of("camera/visual/0") == pytest.approx((WIDTH / 2, HEIGHT / 2), abs=12)
    view.page.mouse.move(5, 5)
    view.until("!studio3d.lookAtPointed()")


def test_what_somebody_points_at_is_marked_there(view: ScenePage):
    place = view.place_of("camera/visual/0")
    view.page.mouse.move(*place)
    view.until("studio3d.pointedPlace() !== null")
    view.run("studio3d.setGuide(studio3d.pointedPlace())")
    view.pictures(1)
    mark = "(({ cx, cy }) => [cx, cy].map((one) => one.baseVal.value))"
    assert view.run(f"{mark}(document.querySelector('circle.guide'))") == pytest.approx(
        place, abs=1.0
    )
    view.run("studio3d.setGuide(null)")


def test_zero_is_rvizs(view: ScenePage):
    view.run("studio3d.zero()")
    assert camera(view)["eye"] == pytest.approx((5, 5, 10 * math.sin(math.pi / 4)), abs=1e-4)


def test_another_browsers_camera_is_shown_as_it_is_until_a_hand_takes_over(view: ScenePage):
    pose = {"position": [0, 0, 4], "target": [0, 0, 0], "up": [1, 0, 0], "flat": True, "field": 0.5}
    view.run("(pose) => studio3d.setCamera(pose)", pose)
    seen = camera(view)
    assert (seen["flat"], seen["up"]) == (True, pytest.approx([1, 0, 0], abs=1e-6))
    shown = view.run("studio3d.getCamera()")
    assert shown["position"] == pytest.approx(pose["position"], abs=1e-6)
    assert (shown["flat"], shown["field"]) == (True, 0.5)
    drag(view, (0, -100))
    seen = camera(view)
    assert seen["flat"]
    assert math.dist(seen["eye"], (0, 0, 0)) == pytest.approx(4, abs=1e-3)
    assert seen["eye"][2] < 3.9
    assert values(view)["Field of View"] == 0.5


def test_a_flight_takes_its_time_unless_motion_is_to_be_calm(view: ScenePage):
    use(view, "Orbit", Yaw=0.0, Pitch=0.0, Distance=4.0)
    view.pictures(1)
    view.page.emulate_media(reduced_motion="no-preference")
    view.run("studio3d.seeFrom([0, 1, 0])")
    view.pictures(1)
    on_way = view.run(CAMERA)["eye"]
    assert on_way[0] > 0.5
    view.until(f"({CAMERA})().eye[1] > 3.999")
    view.page.emulate_media(reduced_motion="reduce")
    view.run("studio3d.seeFrom([1, 0, 0])")
    assert camera(view)["eye"] == pytest.approx((4, 0, 0), abs=1e-4)


def test_a_locked_camera_and_a_view_that_is_none_are_left_alone(view: ScenePage):
    use(view, "FrameAligned", Lock_Camera=True, Yaw=1.0)
    drag(view, (30, 30))
    assert values(view)["Yaw"] == 1.0
    with pytest.raises(Exception, match='There is no view "Ego"'):
        use(view, "Ego")
    use(view, "Orbit", Distance="far", Yaw=1.0)  # type: ignore[arg-type]
    assert all(math.isfinite(one) for one in camera(view)["eye"])
    assert view.errors == []
