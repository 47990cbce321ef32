from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.robot.values import Robot
from studio.scene.ghost import GHOST_RGB
from tests.support.robots import rover
from tests.support.viser_frames import told_of, types_of
from tests.support.watched_scene import URI, poses_of, robot_with_mesh, sent_by, triangle, watched

if TYPE_CHECKING:
    from studio.scene import DocumentScene
    from tests.support.viser_frames import Peer


def test_a_ghost_is_drawn_in_one_colour_see_through_and_without_shadow():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.set_display("ghost", "opacity", 0.5)
        scene.ghost.show(rover())
        sent = sent_by(scene, peer)
        assert all(name.startswith("/ghost") for name in told_of(sent))
        shapes = [m["props"] for m in sent if "color" in m.get("props", {})]
        assert {tuple(props["color"]) for props in shapes} == {GHOST_RGB}
        assert {props["opacity"] for props in shapes} == {0.5}
        assert not any(props["cast_shadow"] or props["receive_shadow"] for props in shapes)
        visuals = sum(len(link.visuals) for link in rover().links.values())
        assert len(shapes) == visuals

    watched(scenario)


def test_a_ghost_moves_by_itself_and_stands_where_it_is_put():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.ghost.show(rover())
        names, poses = poses_of(rover())
        scene.ghost.set_poses(names, poses)
        sent_by(scene, peer)
        lifted = np.array(poses)
        lifted[0, 6] += 1
        scene.ghost.set_poses(names, lifted)
        (moved,) = sent_by(scene, peer)
        assert (moved["type"], moved["name"]) == ("SetPositionMessage", f"/ghost/{names[0]}")
        scene.ghost.shift((0, -2, 0))
        sent = [m for m in sent_by(scene, peer) if m["type"] == "SetPositionMessage"]
        assert [(m["name"], list(m["position"])) for m in sent] == [("/ghost", [0, -2, 0])]

    watched(scenario)


def test_only_links_that_differ_are_drawn_again():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        one = rover()
        scene.ghost.show(one)
        sent_by(scene, peer)
        wheel = rover(wheel_radius_m=0.2).links["wheel_0"]
        scene.ghost.show(replace(one, links={**one.links, "wheel_0": wheel}))
        assert {name.split("/")[2] for name in told_of(sent_by(scene, peer))} == {"wheel_0"}

    watched(scenario)


def test_links_are_hidden_and_shown_again_without_drawing_them():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.ghost.hide({"mast", "elsewhere"})
        scene.ghost.show(rover())
        sent = [m for m in sent_by(scene, peer) if m["type"] == "SetSceneNodeVisibilityMessage"]
        assert [m["name"] for m in sent if not m["visible"]] == ["/ghost/mast"]
        scene.ghost.hide({"wheel_0"})
        sent = sent_by(scene, peer)
        assert set(types_of(sent)) == {"SetSceneNodeVisibilityMessage"}
        assert {m["name"]: m["visible"] for m in sent} == {
            "/ghost/mast": True,
            "/ghost/wheel_0": False,
        }

    watched(scenario)


def test_a_ghost_that_is_taken_away_leaves_nothing():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.ghost.show(rover())
        drawn = told_of(sent_by(scene, peer))
        scene.ghost.show(Robot(""))
        sent = sent_by(scene, peer)
        assert set(types_of(sent)) == {"RemoveSceneNodeMessage"}
        assert told_of(sent) == drawn

    watched(scenario)


def test_a_mesh_that_the_robot_has_is_not_asked_for_again():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.show(robot_with_mesh(), None)
        scene.provide_mesh(URI, triangle(glb=b"colours of its own"))
        sent_by(scene, peer)
        scene.ghost.show(robot_with_mesh(2.0))
        assert scene.missing_meshes() == set()
        sent = sent_by(scene, peer)
        (mesh,) = (m for m in sent if m["type"] == "MeshMessage")
        assert (mesh["name"], tuple(mesh["props"]["color"])) == ("/ghost/base/0", GHOST_RGB)

    watched(scenario)


@pytest.mark.parametrize("comes", [True, False])
def test_a_mesh_of_its_own_is_drawn_when_it_comes(comes: bool):
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.ghost.show(robot_with_mesh())
        assert scene.missing_meshes() == {URI}
        sent_by(scene, peer)
        scene.provide_mesh(URI, triangle() if comes else None)
        assert ("/ghost/base/0" in told_of(sent_by(scene, peer))) == comes
        assert scene.missing_meshes() == set()
        assert (scene.mesh(URI) is not None) == comes

    watched(scenario)


def test_fading_sends_looks_and_no_meshes():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.ghost.show(robot_with_mesh())
        scene.provide_mesh(URI, triangle())
        sent_by(scene, peer)
        scene.set_display("ghost", "opacity", 0.2)
        (sent,) = sent_by(scene, peer)
        assert sent["type"] == "SceneNodeUpdateMessage"
        assert sent["updates"]["opacity"] == pytest.approx(0.2)

    watched(scenario)
