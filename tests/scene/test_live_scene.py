# pyright: reportPrivateUsage=false
from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.displays.drawing import MeshFile, Picture, Placed, Points, Shape, Text
from studio.errors import SceneError
from studio.scene.graph import GRID
from studio.scene.live_scene import GROUPS_MAX
from tests.support.live_shapes import MESH_URI, RED, UPRIGHT, at, drawing_of, every_shape, places
from tests.support.robots import rover
from tests.support.viser_frames import Peer, Sent, eventually, sit_down, told_of, types_of
from tests.support.watched_scene import poses_of, sent_by, triangle, watched

if TYPE_CHECKING:
    from studio.scene import DocumentScene


def points(count: int = 2, size_m: float = 0.1) -> Points:
    return Points(np.zeros((count, 3), np.float32), RED, size_m)


def one(shape: Shape, path: str = "scan") -> dict[str, Placed]:
    return {path: Placed("laser", 0, {"cloud": shape})}


def of_type(sent: list[Sent], kind: str) -> list[Sent]:
    return [message for message in sent if message["type"] == kind]


def test_a_drawing_stands_below_the_root_of_its_display_at_its_poses():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.live.apply("7", one(points()), {"scan": at(1, 2, 3)})
        sent = sent_by(scene, peer)
        assert told_of(sent) == {"/live", "/live/7", "/live/7/scan", "/live/7/scan/cloud.points"}
        *_, place = [m for m in of_type(sent, "SetPositionMessage") if m["name"] == "/live/7/scan"]
        assert list(place["position"]) == [1, 2, 3]
        assert of_type(sent, "SetSceneNodeVisibilityMessage")[-1] == {
            **of_type(sent, "SetSceneNodeVisibilityMessage")[-1],
            "name": "/live/7/scan",
            "visible": True,
        }

    watched(scenario)


def test_the_same_objects_are_not_sent_again():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        drawing = drawing_of(every_shape())
        scene.live.apply("all", drawing, places())
        assert sent_by(scene, peer)
        scene.live.apply("all", dict(drawing), places())
        assert sent_by(scene, peer) == []

    watched(scenario)


def test_a_new_cloud_of_another_size_is_one_update_of_points_and_colours_together():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.live.apply("7", one(points(2)), {"scan": UPRIGHT})
        sent_by(scene, peer)
        scene.live.apply("7", one(points(5)), {"scan": UPRIGHT})
        (update,) = sent_by(scene, peer)
        assert update["type"] == "SceneNodeUpdateMessage"
        assert {"points", "colors", "point_size"} <= update["updates"].keys()

    watched(scenario)


def test_a_size_that_changed_sends_no_array():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        cloud = points()
        scene.live.apply("7", one(cloud), {"scan": UPRIGHT})
        sent_by(scene, peer)
        scene.live.apply("7", one(replace(cloud, size_m=0.5)), {"scan": UPRIGHT})
        (update,) = sent_by(scene, peer)
        assert update["updates"]["point_size"] == 0.25
        assert "points" not in update["updates"]

    watched(scenario)


def test_who_comes_later_gets_the_newest_cloud_once():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        for count in (100_000, 200_000, 50_000):
            scene.live.apply("7", one(points(count)), {"scan": UPRIGHT})
            sent_by(scene, peer)
        late = Peer()
        late.serving = sit_down(scene, late)
        await eventually(lambda: bool(late.frames))
        one_cloud = 50_000 * 6
        assert one_cloud < sum(map(len, late.frames)) < one_cloud + 100_000

    watched(scenario)


def test_what_the_drawing_does_not_have_any_more_is_removed():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        two = {"cloud": points(), "name": Text("a")}
        scene.live.apply("7", {"a": Placed("f", 0, two), "b": Placed("f", 0, two)}, {})
        sent_by(scene, peer)
        scene.live.apply("7", {"a": Placed("f", 0, {"name": two["name"]})}, {"a": UPRIGHT})
        removed = [m["name"] for m in of_type(sent_by(scene, peer), "RemoveSceneNodeMessage")]
        assert removed == [
            "/live/7/b/cloud.points",
            "/live/7/b/name.plain",
            "/live/7/b",
            "/live/7/a/cloud.points",
        ]
        scene.live.drop("7")
        removed = [m["name"] for m in of_type(sent_by(scene, peer), "RemoveSceneNodeMessage")]
        assert removed == ["/live/7/a/name.plain", "/live/7/a", "/live/7"]
        scene.live.drop("7")
        assert sent_by(scene, peer) == []

    watched(scenario)


def test_a_group_that_is_not_connected_is_hidden_until_it_is():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.live.apply("7", one(points()), {"scan": None})
        sent = of_type(sent_by(scene, peer), "SetSceneNodeVisibilityMessage")
        assert {m["name"]: m["visible"] for m in sent}["/live/7/scan"] is False
        scene.live.place("7", {"scan": at(1, 0)})
        sent = sent_by(scene, peer)
        assert [m["visible"] for m in of_type(sent, "SetSceneNodeVisibilityMessage")] == [True]
        scene.live.place("7", {"scan": at(float("nan"), 0)})
        (hidden,) = sent_by(scene, peer)
        assert (hidden["name"], hidden["visible"]) == ("/live/7/scan", False)

    watched(scenario)


def test_placing_moves_what_moved_and_nothing_else_and_a_hair_is_no_move():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        cloud = points()
        drawing = {name: Placed(name, 0, {"cloud": cloud}) for name in "abc"}
        scene.live.apply("7", drawing, dict.fromkeys("abc", UPRIGHT))
        sent_by(scene, peer)
        scene.live.place("7", {"a": at(1, 0), "b": at(1e-9, 0)})
        (moved,) = sent_by(scene, peer)
        assert (moved["type"], moved["name"]) == ("SetPositionMessage", "/live/7/a")
        scene.live.place("no such display", {"a": at(1, 0)})
        assert sent_by(scene, peer) == []

    watched(scenario)


def test_a_quaternion_of_another_length_is_a_turn_and_none_is_no_pose():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        drawing = {name: Placed(name, 0, {"cloud": points()}) for name in "ab"}
        poses = {"a": ((0.0, 0.0, 0.0, 5.0), (0.0, 0.0, 0.0)), "b": ((0.0,) * 4, (0.0,) * 3)}
        scene.live.apply("7", drawing, poses)  # pyright: ignore[reportArgumentType]
        sent = sent_by(scene, peer)
        turns = [m for m in of_type(sent, "SetOrientationMessage") if m["name"] == "/live/7/a"]
        assert list(turns[-1]["wxyz"]) == [0, 0, 0, 1]
        seen = {m["name"]: m["visible"] for m in of_type(sent, "SetSceneNodeVisibilityMessage")}
        assert (seen["/live/7/a"], seen["/live/7/b"]) == (True, False)

    watched(scenario)


def test_a_display_is_hidden_as_a_whole_also_before_it_draws():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.live.show("7", visible=False)
        assert sent_by(scene, peer) == []
        scene.live.apply("7", one(points()), {"scan": UPRIGHT})
        sent = of_type(sent_by(scene, peer), "SetSceneNodeVisibilityMessage")
        assert {m["name"]: m["visible"] for m in sent}["/live/7"] is False
        scene.live.show("7", visible=True)
        (shown,) = sent_by(scene, peer)
        assert (shown["name"], shown["visible"]) == ("/live/7", True)

    watched(scenario)


@pytest.mark.parametrize("text", ["../../robot", "a/b", "", "%2F", "<script>", "ä\n\0", "/robot"])
def test_hostile_names_stay_below_their_display(text: str):
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        drawing = {text: Placed(text, 0, {text.replace("/", ""): points()})}
        scene.live.apply(text, drawing, {text: UPRIGHT})
        names = told_of(sent_by(scene, peer)) - {"/live"}
        assert sorted(name.count("/") for name in names) == [2, 3, 4]
        assert all(name.startswith("/live/") and name.isascii() for name in names)
        assert not any(part == "" for name in names for part in name.split("/")[1:])

    watched(scenario)


def test_a_display_with_a_hundred_thousand_paths_is_refused_and_all_is_as_before():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.live.apply("7", one(points()), {"scan": UPRIGHT})
        sent_by(scene, peer)
        shape = points()
        many = {str(n): Placed("f", 0, {"cloud": shape}) for n in range(100_000)}
        with pytest.raises(SceneError, match=f'"7" draws 100000 groups.*{GROUPS_MAX} of one'):
            scene.live.apply("7", many, {})
        too_large = Points(np.broadcast_to(np.zeros(3, np.float32), (9_000_000, 3)), RED)
        with pytest.raises(SceneError, match="9000000 points"):
            scene.live.apply("7", {"new": Placed("f", 0, {"a": shape, "b": too_large})}, {})
        assert sent_by(scene, peer) == []

    watched(scenario)


def test_a_mesh_is_asked_for_drawn_when_it_comes_and_forgotten_with_its_display():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.live.apply("7", one(MeshFile(MESH_URI)), {"scan": UPRIGHT})
        assert scene.missing_meshes() == {MESH_URI}
        assert "MeshMessage" not in types_of(sent_by(scene, peer))
        scene.provide_mesh(MESH_URI, triangle())
        (drawn,) = of_type(sent_by(scene, peer), "MeshMessage")
        assert drawn["name"] == "/live/7/scan/cloud.mesh"
        assert scene.missing_meshes() == set()
        scene.live.drop("7")
        assert scene.mesh(MESH_URI) is None
        scene.live.apply("8", one(MeshFile(MESH_URI)), {"scan": UPRIGHT})
        assert scene.missing_meshes() == {MESH_URI}

    watched(scenario)


def test_a_mesh_that_many_markers_have_travels_once():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        vertices = np.zeros((30_000, 3), np.float32)
        mesh = replace(triangle(), vertices=vertices)
        drawing = {str(n): Placed("f", 0, {"m": MeshFile(MESH_URI)}) for n in range(50)}
        scene.live.apply("7", drawing, dict.fromkeys(drawing, UPRIGHT))
        sent_by(scene, peer)
        scene.provide_mesh(MESH_URI, mesh)
        scene.flush()
        assert vertices.nbytes < sum(map(len, peer.frames)) < 1.2 * vertices.nbytes
        assert len(of_type(peer.read(), "MeshMessage")) == 50

    watched(scenario)


def test_what_comes_and_goes_under_ever_new_names_leaves_nothing_behind():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        shape = points()
        for number in range(2500):
            scene.live.apply("7", {str(number): Placed("f", 0, {"cloud": shape})}, {})
            if number % 100 == 0:
                sent_by(scene, peer)
        messages = scene.viser._websock_server._broadcast_buffer.message_from_id
        assert len([m for m in messages.values() if m.lifecycle_phase == "remove"]) < 2500

    watched(scenario)


def test_the_robot_and_its_ghost_stand_where_the_root_is_in_the_fixed_frame():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        scene.ghost.show(rover())
        scene.ghost.shift((1, 0, 0))
        sent_by(scene, peer)
        half = (0.0, 0.0, 0.0, 1.0)  # about z
        scene.place_robot(half, (5, 6, 0))
        sent = sent_by(scene, peer)
        places = {m["name"]: list(m["position"]) for m in of_type(sent, "SetPositionMessage")}
        assert places == {"/robot": [5, 6, 0], "/ghost": [4, 6, 0]}
        turns = {m["name"]: list(m["wxyz"]) for m in of_type(sent, "SetOrientationMessage")}
        assert turns == {"/robot": list(half), "/ghost": list(half)}
        scene.set_display("robot", "opacity", 0.5)
        assert types_of(sent_by(scene, peer)) == ["SceneNodeUpdateMessage"]

    watched(scenario)


def test_the_ground_is_laid_under_a_robot_that_is_placed_and_does_not_climb_with_it():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        def heights() -> list[float]:
            sent = of_type(sent_by(scene, peer), "SetPositionMessage")
            return [round(m["position"][2], 6) for m in sent if m["name"] == GRID]

        scene.show(rover(wheel_radius_m=0.5), None)
        scene.set_poses(*poses_of(rover()))
        (before,) = heights()
        assert before < 0
        scene.place_robot(UPRIGHT[0], (3, 0, 0.5))
        assert heights() == [round(before + 0.5, 6)]
        scene.place_robot(UPRIGHT[0], (3, 0, 20))
        assert heights() == []
        scene.place_robot(*UPRIGHT)
        assert heights() == [before]

    watched(scenario)


def map_of(**values: int) -> dict[str, Placed]:
    """Pictures that are as large as may be encoded at once."""
    palette = np.full((256, 4), 7, np.uint8)
    cells = {name: np.full((1024, 1024), value, np.uint8) for name, value in values.items()}
    tiles = {name: Picture(one, (1.0, 1.0), palette=palette) for name, one in cells.items()}
    return {"map": Placed("map", 0, tiles)}


def test_of_a_large_map_one_tile_after_the_other_is_drawn_and_none_that_is_outdated():
    async def scenario(scene: DocumentScene, peer: Peer) -> None:
        def tiles_told() -> set[str]:
            told = told_of(sent_by(scene, peer))
            return {name.rpartition("/")[2] for name in told if name.count("/") == 4}

        scene.live.apply("1", map_of(a=1, b=1, c=1), {"map": UPRIGHT})
        scene.live.draw_waiting()  # in the same tick there is no time for another one
        assert tiles_told() == {"a.0-0"}
        scene.live.draw_waiting()
        assert tiles_told() == {"b.0-0"}
        # Of another map all are new, and what waited of the one before is not drawn any more.
        scene.live.apply("1", map_of(b=2, d=2), {"map": UPRIGHT})
        scene.live.draw_waiting()
        assert tiles_told() == {"a.0-0", "b.0-0"}
        scene.live.draw_waiting()
        assert tiles_told() == {"d.0-0"}
        scene.live.draw_waiting()
        assert tiles_told() == set()
        scene.live.apply("1", map_of(e=3, f=3), {"map": UPRIGHT})
        scene.live.drop("1")
        tiles_told()
        scene.live.draw_waiting()
        assert tiles_told() == set()

    watched(scenario)
