from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.robot.values import Box, Link, Material, Origin, Robot, Visual
from studio.scene.graph import GRID
from tests.support.robots import rover
from tests.support.viser_frames import Peer, told_of, types_of
from tests.support.watched_scene import (
    URI,
    poses_of,
    robot_with_mesh,
    sent_by,
    triangle,
    watched,
    with_link,
)

if TYPE_CHECKING:
    from studio.scene import DocumentScene
    from tests.support.viser_frames import Peer


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


def test_an_origin_that_moved_sends_its_place_and_no_geometry():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        mast = rover().links["mast"]
        moved = replace(mast, visuals=(replace(mast.visuals[0], origin=Origin((0, 0, 0.2))),))
        scene.show(with_link(rover(), moved), frozenset({"mast"}))
        sent = sent_by(scene, peer)
        assert set(types_of(sent)) == {"SetPositionMessage"}
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


def test_the_ground_follows_behind_the_robot_that_reaches_lower():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        wheels = frozenset(name for name in rover().links if name.startswith("wheel"))
        scene.show(rover(wheel_radius_m=0.5), wheels)
        scene.set_poses(*poses_of(rover()))
        *robot, ground = sent_by(scene, peer)
        assert told_of(robot) == {f"/robot/wheel_{n}/visual/{i}" for n in range(4) for i in (0, 1)}
        assert ground["name"] == GRID
        assert ground["position"][2] < -0.3

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


def test_names_of_links_cannot_leave_their_place_in_the_tree():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        hostile = "../../grid/<script>%2F\u00e4"
        scene.show(Robot("one", {hostile: Link(hostile)}), None)
        names = {name for name in told_of(sent_by(scene, peer)) if "script" in name}
        assert {name.count("/") for name in names} == {2, 3}

    watched(scenario)
