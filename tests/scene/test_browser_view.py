from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from studio.robot.values import Robot
from tests.support.robots import rover
from tests.support.scene_page import HEIGHT, WIDTH, ScenePage

if TYPE_CHECKING:
    from collections.abc import Iterator

    from playwright.sync_api import Browser

    from tests.support.scene_server import SceneServer

B = (False, True)
pytestmark = [pytest.mark.browser, pytest.mark.network, pytest.mark.timeout(180)]


@pytest.fixture(scope="module")
def opened(browser: Browser, server: SceneServer) -> Iterator[ScenePage]:
    """One page for all tests: to draw without a GPU takes its time."""
    context = browser.new_context()
    yield ScenePage(context.new_page(), server, rover()).open()
    context.close()


@pytest.fixture
def view(opened: ScenePage) -> ScenePage:
    opened.start_again()
    return opened


def near(found: list[float], wanted: list[float]) -> bool:
    return all(math.isclose(a, b, abs_tol=1e-3) for a, b in zip(found, wanted, strict=True))


def test_the_robot_is_drawn_on_nothing_and_nothing_leaves_the_machine(view: ScenePage):
    x, y = view.place_of("upper%20arm/visual/0")
    view.until(f"colorAt({x}, {y})[3] === 255")
    red, green, blue, _ = view.run(f"colorAt({x}, {y})")
    assert red > green > blue  # amber
    assert view.run("colorAt(5, 5)[3]") < 255
    assert {request.split("/")[2] for request in view.requests if "//" in request} <= {
        f"127.0.0.1:{view.server.port}"
    } | {""}
    assert view.errors == []


def test_visers_own_panel_is_not_to_be_seen(view: ScenePage):
    panels = "[...document.querySelectorAll('[data-floating-window]')]"
    assert view.run(f"{panels}.filter((panel) => panel.checkVisibility()).length") == 0
    assert view.run("document.body.innerText.trim()") == ""


def test_a_wheel_that_grew_changes_on_screen_and_nothing_else_is_made_anew(view: ScenePage):
    view.run("window.mast = __viserMutable.nodeRefFromName['/robot/mast/visual/0']")
    view.run("window.wheel = __viserMutable.nodeRefFromName['/robot/wheel_1/visual/0']")
    wheels = frozenset(f"wheel_{number}" for number in range(4))
    view.server.call(lambda scene: (scene.show(rover(0.2), wheels), scene.flush()))
    view.until("Math.abs(wheel.children[0].scale.x - 0.2) < 1e-6")
    assert view.run("mast === __viserMutable.nodeRefFromName['/robot/mast/visual/0']")


def test_a_wheel_that_grew_is_in_the_first_picture_after_it(view: ScenePage):
    view.run(
        """() => {
          const wheel = __viserMutable.nodeRefFromName["/robot/wheel_1/visual/0"];
          const { scene, messageQueue } = __viserMutable;
          const [push, before] = [messageQueue.push, scene.onBeforeRender];
          messageQueue.push = function (...messages) {
            if (messages.some(({ updates }) => updates?.radius === 0.2)) window.came = true;
            return push.apply(this, messages);
          };
          scene.onBeforeRender = (renderer) => {
            if (window.came) window.firstSeen ??= wheel.children[0].scale.x;
            before(renderer);
          };
        }"""
    )
    wheels = frozenset(f"wheel_{number}" for number in range(4))
    view.server.call(lambda scene: (scene.show(rover(0.2), wheels), scene.flush()))
    view.until("window.firstSeen !== undefined")
    assert math.isclose(view.run("firstSeen"), 0.2, abs_tol=1e-6)


def test_a_picture_that_rests_is_drawn_finer_where_the_processor_draws(
    browser: Browser, server: SceneServer
):
    context = browser.new_context(viewport={"width": WIDTH // 2, "height": HEIGHT // 2})
    page = context.new_page()
    page.goto(server.url)
    assert page.evaluate("document.documentElement.dataset.gl") == "software"
    page.wait_for_function("window.__viserMutable?.canvas?.width === 2 * innerWidth")
    page.evaluate("() => studio3d.setSelection('mast')")
    assert page.evaluate("__viserMutable.canvas.width") == WIDTH // 2
    page.wait_for_function("__viserMutable.canvas.width === 2 * innerWidth")
    context.close()


@pytest.mark.parametrize(
    ("node", "link"),
    [
        ("upper%20arm/visual/0", "upper arm"),
        pytest.param("camera/visual/0", "camera", marks=pytest.mark.sweep),
        pytest.param("finger%2Fleft/visual/0", "finger/left", marks=pytest.mark.sweep),
        ("wheel_1/visual/1", "wheel_1"),
    ],
)
def test_the_link_under_the_mouse_is_told_when_it_hovers_and_is_clicked(
    view: ScenePage, node: str, link: str
):
    view.page.mouse.move(*view.place_of(node))
    view.until("heard.some(([type]) => type === 'hover')")
    assert view.heard("hover") == [{"link": link}]
    view.page.mouse.click(*view.place_of(node))
    assert view.heard("select") == [{"link": link}]


@pytest.fixture
def ghost(view: ScenePage) -> Iterator[ScenePage]:
    """The same, with a ghost of the robot to be shown; it is gone for the next test."""
    yield view
    view.server.call(lambda scene: (scene.ghost.show(Robot("")), scene.flush()))
    view.until("!window.__viserMutable.nodeRefFromName['/ghost/camera/0']")


def show_ghost(view: ScenePage, up_m: float) -> tuple[float, float]:
    """Show one so far above the robot; where its camera is on screen."""
    robot, names = view.robot, view.kinematics.link_names
    poses = view.kinematics.wxyz_xyz(view.kinematics.positions_with_mimic({}))
    view.server.call(
        lambda scene: (
            scene.ghost.show(robot),
            scene.ghost.set_poses(names, poses),
            scene.ghost.shift((0, 0, up_m)),
            scene.flush(),
        )
    )
    view.until("window.__viserMutable.nodeRefFromName['/ghost/camera/0']")
    view.pictures(2)
    x, y = view.run("middleOf('/ghost/camera/0')")
    return x, y


def test_the_ghost_of_a_comparison_is_neither_pointed_at_nor_clicked(ghost: ScenePage):
    x, y = show_ghost(ghost, 0.3)
    red, green, blue, _ = ghost.run(f"colorAt({x}, {y})")
    assert blue > red > green  # it is what is seen there
    ghost.page.mouse.move(x, y)
    ghost.page.mouse.click(x, y)
    assert ghost.heard("select") == [{"link": None}]
    assert {one["link"] for one in ghost.heard("hover")} <= {None}


def test_a_click_goes_through_the_ghost_to_the_robot_in_it(ghost: ScenePage):
    place = show_ghost(ghost, 0.0)
    ghost.page.mouse.click(*place)
    assert ghost.heard("select") == [{"link": "camera"}]


def test_a_click_into_empty_space_takes_the_selection_back(view: ScenePage):
    view.page.mouse.click(8, 8)
    assert view.heard("select") == [{"link": None}]


@pytest.mark.parametrize(
    ("theme", "line"),
    [
        ("dark", "77,179,255"),
        pytest.param("light", "23,105,210", marks=pytest.mark.sweep),
    ],
)
def test_a_selected_link_keeps_its_colours_and_is_outlined(view: ScenePage, theme: str, line: str):
    x, y = view.place_of("lidar/visual/0")
    view.run(f"studio3d.setTheme('{theme}')")
    view.pictures(3)
    plain = view.run(f"colorAt({x}, {y})")
    assert view.run("(rgb) => placesOf(rgb)", line) == []
    view.run("studio3d.setSelection('lidar')")
    view.pictures(3)
    around = view.run("(rgb) => placesOf(rgb)", line)
    white = view.run("placesOf('255,255,255')")
    assert view.run(f"colorAt({x}, {y})") == plain
    assert {(one > x, other > y) for one, other in around} == {(a, b) for a in B for b in B}
    assert {(one > x, other > y) for one, other in white} == {(a, b) for a in B for b in B}
    view.run("studio3d.setSelection(null)")
    view.pictures(3)
    assert view.run("(rgb) => placesOf(rgb)", line) == []


def test_an_outline_is_seen_through_what_is_in_front(view: ScenePage):
    view.run("studio3d.view('bottom')")
    view.run("studio3d.setSelection('lidar')")
    view.pictures(3)
    assert len(view.run("placesOf('77,179,255')")) > 40


def test_dragging_a_link_turns_its_joint_within_its_limits(view: ScenePage):
    view.run("studio3d.view('right')")
    view.pictures(2)
    camera = view.run("studio3d.getCamera()")
    start = view.place_of("forearm/visual/0")
    view.draw_mouse(start, (20, 5))
    view.until("heard.some(([type, { phase }]) => type === 'drag' && phase === 'move')")
    view.page.mouse.up()
    drags = view.heard("drag")
    assert [drag["phase"] for drag in drags][:1] == ["start"]
    assert drags[-1]["phase"] == "end"
    assert {drag["joint"] for drag in drags} == {"bend"}
    assert drags[0]["value"] == 0.0
    assert 0.0 < drags[-1]["value"] < 1.5  # seen from the right, a turn about y goes with the clock
    assert view.run("studio3d.getCamera()") == camera


def test_a_drag_ends_at_the_limit(view: ScenePage):
    view.run("studio3d.view('right')")
    view.pictures(2)
    x, y = view.place_of("forearm/visual/0")
    view.draw_mouse((x, y), (60, 140))
    view.page.mouse.up()
    assert view.heard("drag")[-1]["value"] == 1.5


def test_what_is_dragged_moves_as_far_as_the_mouse(view: ScenePage):
    view.run("studio3d.view('front')")
    view.pictures(2)
    joint, (went, _) = view.draw_link("finger%2Fleft/visual/0", (9, 0))
    assert joint == "grip"
    assert went == pytest.approx(9, abs=1.0)


def test_dragging_a_follower_moves_what_it_follows_the_other_way_round(view: ScenePage):
    view.run("studio3d.view('front')")
    view.pictures(2)
    view.draw_mouse(view.place_of("finger%2Fright/visual/0"), (-9, 0))
    view.page.mouse.up()
    drag = view.heard("drag")[-1]
    assert drag["joint"] == "grip"
    assert drag["value"] > 0.0


def test_escape_gives_the_start_value_back(view: ScenePage):
    view.draw_mouse(view.place_of("camera/visual/0"), (25, 0))
    view.until("heard.some(([type, { phase }]) => type === 'drag' && phase === 'move')")
    assert view.run("document.querySelector('.studio-drag-label').textContent").startswith("camera")
    view.page.keyboard.press("Escape")
    view.page.mouse.up()
    drags = view.heard("drag")
    assert (drags[-1]["phase"], drags[-1]["value"]) == ("cancel", 0.0)


def test_one_who_may_not_drag_turns_the_camera_instead(view: ScenePage):
    before = view.run("studio3d.getCamera()")
    view.run("studio3d.setCanDrag(false)")
    view.draw_mouse(view.place_of("camera/visual/0"), (60, 0))
    view.page.mouse.up()
    view.until("true")
    assert view.heard("drag") == []
    assert not near(view.run("studio3d.getCamera()")["position"], before["position"])


def test_keys_reach_the_page_around_and_not_viser(view: ScenePage):
    view.page.keyboard.press("Control+s")
    view.page.keyboard.press("w")
    keys = [(key["key"], key["ctrlKey"]) for key in view.heard("key")]
    assert keys == [("Control", True), ("s", True), ("w", False)]


def test_fit_fills_two_thirds_of_the_view(view: ScenePage):
    view.run("studio3d.view('front')")
    view.pictures(2)
    places: list[Any] = view.run(
        """() => Object.keys(__viserMutable.nodeRefFromName)
             .filter((name) => /^\\/robot\\/[^/]+\\/visual\\/\\d+$/.test(name)).map(middleOf)"""
    )
    height = max(y for _, y in places) - min(y for _, y in places)
    assert 0.45 < height / HEIGHT < 0.7


def test_after_a_cut_connection_all_is_as_it_was(view: ScenePage):
    view.run("studio3d.view('left')")
    view.pictures(2)
    camera = view.run("studio3d.getCamera()")
    view.run("studio3d.setLinkVisible('mast', false)")
    view.run("studio3d.setSelection('lidar')")
    view.server.drop_connections()
    view.until("heard.filter(([type]) => type === 'connection').length === 2")
    assert [told["connected"] for told in view.heard("connection")] == [False, True]
    view.until("__viserMutable.nodeRefFromName['/robot/wheel_3/visual/0']")
    view.until("__viserMutable.nodeRefFromName['/robot/mast'].visible === false")
    assert near(view.run("studio3d.getCamera()")["position"], camera["position"])


def test_a_view_comes_back_though_a_connection_takes_longer_than_viser_waits(view: ScenePage):
    """viser asks for another one each second."""
    view.server.handshake_s = 1.5
    try:
        view.server.drop_connections()
        view.until("heard.filter(([type]) => type === 'connection').length === 2")
    finally:
        view.server.handshake_s = 0.0
    assert [told["connected"] for told in view.heard("connection")] == [False, True]


def test_a_link_stays_hidden_when_it_is_made_anew(view: ScenePage):
    view.run("studio3d.setLinkVisible('mast', false)")
    without = rover()
    links = {name: link for name, link in without.links.items() if name != "mast"}
    view.server.call(lambda scene: (scene.show(replace(without, links=links), None), scene.flush()))
    view.until("!__viserMutable.nodeRefFromName['/robot/mast']")
    view.server.call(lambda scene: (scene.show(rover(), None), scene.flush()))
    view.until("__viserMutable.nodeRefFromName['/robot/mast']?.visible === false")


def test_a_see_through_link_lets_what_is_behind_it_be_seen_and_others_be_as_they_are(
    view: ScenePage,
):
    x, y = view.place_of("lidar/visual/0")
    view.until(f"colorAt({x}, {y})[2] > colorAt({x}, {y})[0]")  # blue
    view.run("studio3d.setLinkOpacity('lidar', 0.05)")
    view.until(f"colorAt({x}, {y})[0] > colorAt({x}, {y})[2]")  # the amber deck
    view.run("studio3d.setLinkOpacity('lidar', 1)")
    view.until(f"colorAt({x}, {y})[2] > colorAt({x}, {y})[0]")


def test_the_opacity_of_the_robot_is_every_link_s(view: ScenePage):
    x, y = view.place_of("camera/visual/0")
    view.until(f"colorAt({x}, {y})[3] === 255")
    view.server.call(lambda scene: (scene.set_display("robot", "opacity", 0.1), scene.flush()))
    view.until(f"colorAt({x}, {y})[3] < 200")


def test_the_themes_have_grids_and_backgrounds_of_their_own(view: ScenePage):
    def looks() -> tuple[str, list[float]]:
        background = view.run(
            "getComputedStyle(document.querySelector('canvas[data-engine]')).backgroundImage"
        )
        return background, view.run(
            """() => { let line; __viserMutable.nodeRefFromName['/grid'].traverse((object) => {
                 if (object.material?.uniforms?.cellColor) line = object.material; });
                 return line.uniforms.cellColor.value.toArray(); }"""
        )

    view.run("studio3d.setTheme('dark')")
    view.pictures(3)
    dark = looks()
    view.run("studio3d.setTheme('light')")
    view.pictures(3)
    light = looks()
    assert dark[0] != light[0]
    assert dark[1] != light[1]


def test_the_grid_is_calmed_before_it_shimmers(view: ScenePage):
    assert view.run(
        """() => { let found = ""; __viserMutable.nodeRefFromName['/grid'].traverse((object) => {
             if (object.material?.fragmentShader) found = object.material.fragmentShader; });
             return found.includes("density"); }"""
    )


def test_a_double_click_brings_a_link_to_the_middle(view: ScenePage):
    view.page.mouse.dblclick(*view.place_of("camera/visual/0"))
    assert view.heard("focus") == [{"link": "camera"}]
    view.pictures(2)
    assert view.place_of("camera/visual/0") == pytest.approx((WIDTH / 2, HEIGHT / 2), abs=25)
