from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.errors import SceneError
from studio.robot.values import Box, Joint, JointType, Link, Origin, Robot, Visual
from studio.scene import DISPLAY_DEFAULTS
from tests.support.robots import rover
from tests.support.viser_frames import Peer, told_of, types_of
from tests.support.watched_scene import URI, robot_with_mesh, sent_by, triangle, watched

if TYPE_CHECKING:
    from studio.scene import DocumentScene
    from tests.support.viser_frames import Peer


def test_collisions_and_their_meshes_are_made_when_they_are_first_shown():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(robot_with_mesh(collision=True), None)
        assert scene.missing_meshes() == {URI}
        assert not any("collision" in name for name in told_of(sent_by(scene, peer)))
        scene.set_display("robot", "collision", True)
        assert scene.missing_meshes() == {URI, "package://parts/hull.stl"}
        scene.provide_mesh("package://parts/hull.stl", triangle())
        assert "/robot/base/collision/0" in told_of(sent_by(scene, peer))
        scene.set_display("robot", "collision", False)
        [message] = sent_by(scene, peer)
        assert (message["name"], message["visible"]) == ("/robot/base/collision", False)

    watched(scenario)


@pytest.mark.parametrize(
    ("layer", "node"),
    [
        ("frames", "/robot/mast/frame"),
        ("names", "/robot/mast/name"),
        ("axes", "/robot/camera/axis"),
        ("inertia", "/robot/mast/inertia"),
        ("com", "/robot/mast/com"),
    ],
)
def test_a_layer_is_made_when_it_is_first_shown_then_only_hidden(layer: str, node: str):
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.set_display("robot", layer, True)
        assert node in told_of(sent_by(scene, peer))
        scene.set_display("robot", layer, False)
        assert set(types_of(sent_by(scene, peer))) == {"SetSceneNodeVisibilityMessage"}
        scene.set_display("robot", layer, True)
        assert set(types_of(sent_by(scene, peer))) == {"SetSceneNodeVisibilityMessage"}

    watched(scenario)


def test_a_joint_axis_that_changed_turns_the_arrow_of_its_child():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.set_display("robot", "axes", True)
        sent_by(scene, peer)
        robot = rover()
        joints = {**robot.joints, "camera": replace(robot.joints["camera"], axis=(0.0, 2.0, 0.0))}
        scene.show(replace(robot, joints=joints), frozenset())
        assert "/robot/camera/axis" in told_of(sent_by(scene, peer))

    watched(scenario)


@pytest.mark.parametrize("axis", [(0.0, 0.0, 0.0), (float("inf"), 0.0, 0.0)])
def test_a_joint_without_a_direction_has_no_arrow(axis: tuple[float, float, float]):
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.set_display("robot", "axes", True)
        links = {name: Link(name) for name in ("a", "b")}
        joint = Joint("j", JointType.REVOLUTE, "a", "b", axis=axis)
        scene.show(Robot("two", links, {"j": joint}), None)
        assert "/robot/b/axis" not in told_of(sent_by(scene, peer))

    watched(scenario)


def test_the_opacity_of_the_robot_is_one_message():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.set_display("robot", "opacity", 0.25)
        [message] = sent_by(scene, peer)
        assert (message["name"], message["updates"]["origin_radius"]) == ("/robot", 0.25)

    watched(scenario)


def test_the_grid_is_changed_in_place():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.set_display("grid", "cell_m", 1.0)
        scene.set_display("grid", "visible", False)
        sent = [m for m in sent_by(scene, peer) if m.get("name") == "/grid"]
        assert types_of(sent) == ["SceneNodeUpdateMessage", "SetSceneNodeVisibilityMessage"]

    watched(scenario)


@pytest.mark.parametrize(
    ("display", "name", "value"),
    [
        ("robot", "wings", True),
        ("sky", "visible", True),
        ("robot", "visual", 1.0),
        ("robot", "opacity", "much"),
        ("robot", "opacity", True),
        ("grid", "cell_m", float("nan")),
    ],
)
def test_a_setting_that_cannot_be_is_refused_and_changes_nothing(
    display: str, name: str, value: float | str
):
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        with pytest.raises(SceneError):
            scene.set_display(display, name, value)
        assert scene.displays() == DISPLAY_DEFAULTS
        assert sent_by(scene, peer) == []

    watched(scenario)


def test_numbers_are_kept_within_their_range():
    async def scenario(scene: DocumentScene, _: Peer) -> None:
        scene.set_display("robot", "opacity", 7)
        assert scene.displays()["robot"]["opacity"] == 1.0

    watched(scenario)


def test_the_grid_lies_under_a_robot_that_reaches_below_its_root():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        leg = Link("leg", (Visual(Origin((0, 0, -0.5)), Box((0.1, 0.1, 1.0))),))
        scene.show(Robot("one", {"leg": leg}), None)
        scene.set_poses(("leg",), np.array([[1.0, 0, 0, 0, 0, 0, -0.25]]))
        grid = [m for m in sent_by(scene, peer) if m.get("name") == "/grid"]
        assert [m["position"] for m in grid if "position" in m] == [[0.0, 0.0, -1.25]]
        scene.set_poses(("leg",), np.array([[0.0, 1.0, 0, 0, 0, 0, -0.25]]))
        assert told_of(sent_by(scene, peer)) == {"/robot/leg"}
        scene.set_display("grid", "under_robot", False)
        grid = [m for m in sent_by(scene, peer) if m.get("name") == "/grid"]
        assert [m["position"] for m in grid if "position" in m] == [[0.0, 0.0, 0.0]]

    watched(scenario)


def test_the_grid_sinks_with_a_mesh_that_came():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(robot_with_mesh(scale=-2.0), None)
        scene.set_poses(("base",), np.array([[0.0, 1.0, 0, 0, 0, 0, 0]]))
        sent_by(scene, peer)
        tall = replace(triangle(), bounds_m=((0, 0, 0), (1, 1, 3)))
        scene.provide_mesh(URI, tall)
        assert [
            m["position"][2]
            for m in sent_by(scene, peer)
            if m["name"] == "/grid" and "position" in m
        ] == []
        scene.set_poses(("base",), np.array([[1.0, 0, 0, 0, 0, 0, 0]]))
        scene.show(robot_with_mesh(scale=-2.0), None)
        scene.set_poses(("base",), np.array([[1.0, 0, 0, 0, 0, 0, 0]]))
        grid = [m for m in sent_by(scene, peer) if m["name"] == "/grid" and "position" in m]
        assert [m["position"][2] for m in grid] == [-6.0]

    watched(scenario)
