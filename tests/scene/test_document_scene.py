from __future__ import annotations

import asyncio
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from studio.errors import SceneError
from studio.robot.kinematics import Kinematics
from studio.robot.loaded_mesh import LoadedMesh
from studio.robot.values import (
    Box,
    Collision,
    Joint,
    JointType,
    Link,
    Material,
    Mesh,
    Origin,
    Robot,
    Visual,
)
from studio.scene import DISPLAY_DEFAULTS, DocumentScene
from tests.support.robots import rover
from tests.support.viser_frames import Peer, Sent, joined, told_of, types_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

URI = "package://parts/wheel.stl"


def watched(scenario: Callable[[DocumentScene, Peer], Awaitable[None]]) -> None:
    """Run a scenario on a scene that shows the rover, and a peer that has seen it."""

    async def run() -> None:
        scene = DocumentScene(asyncio.get_running_loop())
        scene.show(rover(), None)
        scene.set_poses(*poses_of(rover()))
        peer, _ = await joined(scene)
        await scenario(scene, peer)
        scene.close()
        await asyncio.sleep(0)

    asyncio.run(run())


def poses_of(robot: Robot) -> tuple[tuple[str, ...], np.ndarray[Any, Any]]:
    kinematics = Kinematics(robot)
    return kinematics.link_names, kinematics.wxyz_xyz(kinematics.zero_positions())


def sent_by(scene: DocumentScene, peer: Peer) -> list[Sent]:
    scene.flush()
    return peer.read()


def with_link(robot: Robot, link: Link) -> Robot:
    return replace(robot, links={**robot.links, link.name: link})


def triangle(digest: str = "one", *, glb: bytes = b"") -> LoadedMesh:
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], dtype=np.float32)
    faces = np.array([[0, 1, 2]], dtype=np.uint32)
    return LoadedMesh(digest, vertices, faces, glb, ((0, 0, 0), (1, 1, 0)))


def robot_with_mesh(scale: float = 1.0, *, collision: bool = False) -> Robot:
    mesh = Mesh(URI, (scale, scale, scale))
    link = Link(
        "base",
        (Visual(Origin(), mesh, Material("", (1, 0, 0, 1))),),
        (Collision(Origin(), Mesh("package://parts/hull.stl")),) if collision else (),
    )
    return Robot("one", {"base": link})


def test_a_robot_that_did_not_change_sends_nothing():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(rover(), None)
        scene.set_poses(*poses_of(rover()))
        assert sent_by(scene, peer) == []

    watched(scenario)


def test_a_primitive_that_grew_sends_that_one_geometry():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        wheels = frozenset(name for name in rover().links if name.startswith("wheel"))
        scene.show(rover(wheel_radius_m=0.12), wheels)
        sent = sent_by(scene, peer)
        assert set(types_of(sent)) == {"SceneNodeUpdateMessage"}
        assert told_of(sent) == {f"/robot/wheel_{n}/visual/{i}" for n in range(4) for i in (0, 1)}
        assert {m["updates"]["radius"] for m in sent} == {0.12, 0.06}

    watched(scenario)


def test_only_the_changed_links_are_looked_at():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(rover(wheel_radius_m=0.12), frozenset({"wheel_1"}))
        assert {name.split("/")[2] for name in told_of(sent_by(scene, peer))} == {"wheel_1"}

    watched(scenario)


def test_an_origin_that_moved_sends_a_pose_and_no_geometry():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        mast = rover().links["mast"]
        moved = replace(mast, visuals=(replace(mast.visuals[0], origin=Origin((0, 0, 0.2))),))
        scene.show(with_link(rover(), moved), frozenset({"mast"}))
        sent = sent_by(scene, peer)
        assert set(types_of(sent)) == {"SetOrientationMessage", "SetPositionMessage"}
        assert told_of(sent) == {"/robot/mast/visual/0"}

    watched(scenario)


def test_a_colour_that_changed_is_an_update_in_place():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        mast = rover().links["mast"]
        red = Material("red", (1.0, 0.0, 0.0, 0.5))
        painted = replace(mast, visuals=(replace(mast.visuals[0], material=red),))
        scene.show(with_link(rover(), painted), frozenset({"mast"}))
        [message] = sent_by(scene, peer)
        assert message["type"] == "SceneNodeUpdateMessage"
        assert message["updates"]["color"] == [255, 0, 0]
        assert message["updates"]["opacity"] == 0.5

    watched(scenario)


def test_a_material_by_name_is_looked_up_in_the_robot():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        visual = Visual(Origin(), Box((1, 1, 1)), Material("steel"))
        steel = {"steel": Material("steel", (0.0, 0.0, 1.0, 1.0))}
        scene.show(Robot("one", {"base": Link("base", (visual,))}, materials=steel), None)
        boxes = [m for m in sent_by(scene, peer) if m["type"] == "BoxMessage"]
        assert [box["props"]["color"] for box in boxes] == [[0, 0, 255]]

    watched(scenario)


def test_links_that_went_vanish_with_all_below_them_and_children_first():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        robot = rover()
        links = {name: link for name, link in robot.links.items() if name != "lidar"}
        joints = {name: joint for name, joint in robot.joints.items() if name != "lidar"}
        scene.show(replace(robot, links=links, joints=joints), frozenset())
        sent = sent_by(scene, peer)
        assert [(m["type"], m["name"]) for m in sent] == [
            ("RemoveSceneNodeMessage", "/robot/lidar/visual/0"),
            ("RemoveSceneNodeMessage", "/robot/lidar/visual"),
            ("RemoveSceneNodeMessage", "/robot/lidar"),
        ]

    watched(scenario)


def test_a_link_that_came_back_is_drawn_and_posed_again():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        robot = rover()
        links = {name: link for name, link in robot.links.items() if name != "lidar"}
        scene.show(replace(robot, links=links), frozenset())
        scene.show(robot, frozenset())
        scene.set_poses(*poses_of(robot))
        sent = sent_by(scene, peer)
        places = [m["position"] for m in sent if m["name"] == "/robot/lidar" and "position" in m]
        assert places[-1] == pytest.approx([0.05, -0.08, 0.35])

    watched(scenario)


def test_poses_of_links_that_did_not_move_are_not_sent():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        names, poses = poses_of(rover())
        poses[names.index("mast"), 4] += 1e-3
        poses[names.index("camera"), 4] += 1e-9
        scene.set_poses(names, poses)
        assert [(m["type"], m["name"]) for m in sent_by(scene, peer)] == [
            ("SetPositionMessage", "/robot/mast")
        ]

    watched(scenario)


def test_small_moves_far_from_the_origin_are_not_lost():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        pose = np.array([[1.0, 0, 0, 0, 500_000.0, 0, 0]])
        scene.set_poses(("mast",), pose)
        sent_by(scene, peer)
        pose[0, 4] += 0.001
        scene.set_poses(("mast",), pose)
        assert [m["position"][0] for m in sent_by(scene, peer)] == [500_000.001]

    watched(scenario)


def test_poses_that_are_no_numbers_leave_the_link_where_it_was():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.set_poses(("mast",), np.array([[1.0, 0, 0, 0, np.nan, 0, 0]]))
        scene.set_poses(("no such link",), np.array([[1.0, 0, 0, 0, 0, 0, 0]]))
        assert sent_by(scene, peer) == []

    watched(scenario)


def test_a_mesh_is_asked_for_drawn_when_it_comes_and_not_sent_again_when_it_only_grows():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(robot_with_mesh(), None)
        assert scene.missing_meshes() == {URI}
        sent_by(scene, peer)
        scene.provide_mesh(URI, triangle())
        assert scene.missing_meshes() == set()
        assert types_of(sent_by(scene, peer))[0] == "MeshMessage"
        scene.show(robot_with_mesh(scale=2.0), frozenset({"base"}))
        [message] = sent_by(scene, peer)
        assert message["updates"]["scale"] == [2.0, 2.0, 2.0]
        assert "vertices" not in message["updates"]

    watched(scenario)


def test_a_mesh_file_that_changed_on_disk_is_sent_again_and_an_equal_one_is_not():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(robot_with_mesh(), None)
        scene.provide_mesh(URI, triangle("one"))
        sent_by(scene, peer)
        scene.provide_mesh(URI, triangle("one"))
        assert sent_by(scene, peer) == []
        scene.provide_mesh(URI, triangle("two"))
        assert "MeshMessage" in types_of(sent_by(scene, peer))

    watched(scenario)


def test_a_mesh_with_materials_of_its_own_keeps_them():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(robot_with_mesh(), None)
        sent_by(scene, peer)
        scene.provide_mesh(URI, triangle(glb=b"glTF of a wheel"))
        [glb] = [m for m in sent_by(scene, peer) if m["type"] == "GlbMessage"]
        assert glb["props"]["glb_data"] == {"__binary_index": 0, "dtype": "|u1"}

    watched(scenario)


def test_a_mesh_that_failed_is_a_box_of_wire_until_it_comes():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(robot_with_mesh(), None)
        sent_by(scene, peer)
        scene.provide_mesh(URI, None)
        [box] = [m for m in sent_by(scene, peer) if m["type"] == "BoxMessage"]
        assert box["props"]["wireframe"]
        assert scene.missing_meshes() == set()
        scene.provide_mesh(URI, triangle())
        assert "MeshMessage" in types_of(sent_by(scene, peer))

    watched(scenario)


def test_meshes_that_no_robot_names_are_forgotten():
    async def scenario(scene: DocumentScene, _: Peer) -> None:
        scene.show(robot_with_mesh(), None)
        scene.provide_mesh(URI, triangle())
        scene.show(rover(), None)
        scene.show(robot_with_mesh(), None)
        assert scene.missing_meshes() == {URI}

    watched(scenario)


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


def test_names_of_links_cannot_leave_their_place_in_the_tree():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        hostile = "../../grid/<script>%2F\u00e4"
        scene.show(Robot("one", {hostile: Link(hostile)}), None)
        names = {name for name in told_of(sent_by(scene, peer)) if "script" in name}
        assert {name.count("/") for name in names} == {2, 3}

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
