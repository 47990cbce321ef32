"""FollowedFrames: frames that cameras go with or pages mark, kept while somebody asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, Protocol

from studio.displays.drawing import Placed
from studio.errors import FrameError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.drawing import Drawing
    from studio.engine.live.placing import Lookup, Pose

FOLLOWED: Final = "followed"
"""Their root in the scene, beside those of displays; the page knows its name."""
FOLLOWED_MAX: Final = 64
"""By all who look; one page marks sixteen at once, and its camera goes with one."""
FOLLOWED_FOR_NS: Final = 5_000_000_000
"""After the last question of somebody, who asks every two seconds."""


class DrawsLive(Protocol):
    """What of a live scene is needed."""

    def apply(self, display_id: str, drawing: Drawing, poses: Mapping[str, Pose | None]) -> None:
        """Draw another state."""
        ...

    def place(self, display_id: str, poses: Mapping[str, Pose | None]) -> None:
        """Move what is drawn."""
        ...

    def drop(self, display_id: str) -> None:
        """Draw it no more."""
        ...


class FollowedFrames:
    """Each is an empty group that stands where the frame is: a pose is all that it costs."""

    def __init__(self, scene: DrawsLive) -> None:
        self._scene = scene
        self._until_ns: dict[str, int] = {}
        self._drawn: tuple[str, ...] = ()

    def ask(self, frame: str, now_ns: int) -> str:
        """Have a frame followed for a while; answers why it cannot be, else nothing."""
        if frame not in self._until_ns and len(self._until_ns) >= FOLLOWED_MAX:
            return f"{FOLLOWED_MAX} other frames are followed already: choose one of those."
        self._until_ns[frame] = now_ns + FOLLOWED_FOR_NS
        return ""

    def step(self, lookup: Lookup, now_ns: int) -> None:
        """Put each where its frame is now; one that is nowhere stays where it was."""
        for frame in [one for one, until_ns in self._until_ns.items() if until_ns <= now_ns]:
            del self._until_ns[frame]
        wanted = tuple(self._until_ns)
        poses = {frame: pose for frame in wanted if (pose := _pose(lookup, frame)) is not None}
        if wanted == self._drawn:
            self._scene.place(FOLLOWED, poses)
        elif wanted:
            drawing = {frame: Placed(frame, 0, follows=True) for frame in wanted}
            self._scene.apply(FOLLOWED, drawing, poses)
        else:
            self._scene.drop(FOLLOWED)
        self._drawn = wanted


def _pose(lookup: Lookup, frame: str) -> Pose | None:
    try:
        return lookup(frame, 0)
    except FrameError:
        return None
