from __future__ import annotations

from typing import TYPE_CHECKING

from studio.displays.drawing import NO_TURN
from studio.engine.live.followed_frames import FOLLOWED_FOR_NS, FOLLOWED_MAX, FollowedFrames
from studio.errors import UnknownFrameError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.drawing import Drawing
    from studio.engine.live.placing import Pose

NOW = 1_000_000_000


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
    assert followed.ask("odom", NOW) == ""
    assert followed.ask("nowhere", NOW) == ""
    followed.step(lookup, NOW)
    followed.step(lookup, NOW + 1)
    there = {"odom": (NO_TURN, (4.0, 0.0, 0.0))}
    assert scene.asked == [("draw odom nowhere", there), ("place", there)]
    followed.ask("odom", NOW + 2)
    followed.step(lookup, NOW + FOLLOWED_FOR_NS)
    assert scene.asked[2:] == [("draw odom", there)]
    followed.step(lookup, NOW + 2 + FOLLOWED_FOR_NS)
    followed.step(lookup, NOW + 3 + FOLLOWED_FOR_NS)
    assert scene.asked[3:] == [("drop", {})]


def test_frames_without_end_are_not_followed():
    followed = FollowedFrames(Scene())
    for number in range(FOLLOWED_MAX):
        assert followed.ask(f"f{number}", NOW) == ""
    assert followed.ask("one more", NOW) == (
        f"{FOLLOWED_MAX} other frames are followed already: choose one of those."
    )
    assert followed.ask("f3", NOW) == ""
