from __future__ import annotations

from typing import TYPE_CHECKING

from studio.displays.drawing import NO_TURN
from studio.errors import UnknownFrameError
from studio.live.displays.followed_frames import (
    FOLLOWED_BY_VIEWER_MAX,
    FOLLOWED_FOR_NS,
    FOLLOWED_MAX,
    FollowedFrames,
)
from studio.protocol.roles import Role, Visitor

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.drawing import Drawing, Pose

NOW = 1_000_000_000
PRESENTER = Visitor(Role.PRESENTER, "p")


class Scene:
    """What was asked of a scene, in its order."""

    def __init__(self) -> None:
        self.asked: list[tuple[str, dict[str, Pose | None]]] = []

    def apply(self, display_id: str, drawing: Drawing, poses: Mapping[str, Pose | None]) -> None:
        assert display_id == "followed"
        assert all(one.follows and not one.shapes for one in drawing.values())
        self.asked.append((f"draw {' '.join(drawing)}", dict(poses)))

    def place(self, display_id: str, poses: Mapping[str, Pose | None]) -> None:
        assert display_id == "followed"
        if poses:
            self.asked.append(("place", dict(poses)))

    def drop(self, display_id: str) -> None:
        assert display_id == "followed"
        self.asked.append(("drop", {}))


def lookup(frame: str, stamp_ns: int) -> Pose:
    assert stamp_ns == 0
    if frame == "nowhere":
        raise UnknownFrameError(frame)
    return NO_TURN, (float(len(frame)), 0.0, 0.0)


def test_a_frame_that_is_asked_for_stands_in_the_scene_until_nobody_asks_any_more():
    scene = Scene()
    followed = FollowedFrames(scene)
    followed.step(lookup, NOW)
    assert scene.asked == []
    assert followed.ask("odom", NOW, PRESENTER) == ""
    assert followed.ask("nowhere", NOW, PRESENTER) == ""
    followed.step(lookup, NOW)
    followed.step(lookup, NOW + 1)
    there = {"odom": (NO_TURN, (4.0, 0.0, 0.0))}
    assert scene.asked == [("draw odom nowhere", there), ("place", there)]
    followed.ask("odom", NOW + 2, PRESENTER)
    followed.step(lookup, NOW + FOLLOWED_FOR_NS)
    assert scene.asked[2:] == [("draw odom", there)]
    followed.step(lookup, NOW + 2 + FOLLOWED_FOR_NS)
    followed.step(lookup, NOW + 3 + FOLLOWED_FOR_NS)
    assert scene.asked[3:] == [("drop", {})]


def test_frames_without_end_are_not_followed():
    followed = FollowedFrames(Scene())
    for number in range(FOLLOWED_MAX):
        assert followed.ask(f"f{number}", NOW, PRESENTER) == ""
    assert followed.ask("one more", NOW, PRESENTER) == (
        f"{FOLLOWED_MAX} other frames are followed already: choose one of those."
    )
    assert followed.ask("f3", NOW, PRESENTER) == ""


def test_viewers_take_no_frame_from_the_presenter():
    followed = FollowedFrames(Scene())
    for viewer in range(10):
        for number in range(100):
            followed.ask(f"v{viewer}_{number}", NOW, Visitor(Role.GUEST, str(viewer)))
    for number in range(FOLLOWED_MAX):
        assert followed.ask(f"f{number}", NOW, PRESENTER) == ""


def test_one_viewer_follows_as_many_as_a_page_needs_and_leaves_room_for_another():
    scene = Scene()
    followed = FollowedFrames(scene)
    greedy = [Visitor(Role.GUEST, name) for name in "abcdefgh"]
    for viewer in greedy:
        told = [followed.ask(f"{viewer.person}{n}", NOW, viewer) for n in range(100)]
        assert told.count("") <= FOLLOWED_BY_VIEWER_MAX
    late = Visitor(Role.GUEST, "late")
    assert [followed.ask(f"late{n}", NOW, late) for n in range(3)] == ["", "", ""]
    followed.step(lookup, NOW)
    ((drawn, poses),) = scene.asked
    assert len(poses) == FOLLOWED_MAX
    assert {"late0", "late1", "late2"} <= set(drawn.split())
