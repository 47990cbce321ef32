"""FollowedFrames: frames that cameras go with or pages mark, kept while somebody asks."""

from __future__ import annotations

from itertools import chain
from typing import TYPE_CHECKING, Final, Protocol

from studio.displays.drawing import Placed
from studio.errors import FrameError
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.drawing import Drawing, Pose
    from studio.live.displays.placing import Lookup
    from studio.protocol.roles import Visitor

FOLLOWED: Final = "followed"
"""Their root in the scene, beside those of displays; the page knows its name."""
FOLLOWED_MAX: Final = 64
"""Limit for all presenters together, and another such for all viewers."""
FOLLOWED_BY_VIEWER_MAX: Final = 17
"""Limit for one viewer: a page marks sixteen at once, and its camera follows one."""
FOLLOWED_FOR_NS: Final = 5_000_000_000
"""After the last request; pages ask every two seconds."""
_TOO_MANY: Final = "{} other frames are followed already: choose one of those."


class DrawsLive(Protocol):
    """The part of a live scene that is used."""

    def apply(self, display_id: str, drawing: Drawing, poses: Mapping[str, Pose | None]) -> None:
        """Draw another state."""
        ...

    def place(self, display_id: str, poses: Mapping[str, Pose | None]) -> None:
        """Move what is drawn."""
        ...

    def drop(self, display_id: str) -> None:
        """Draw it no more."""
        ...


class _Asked:
    """The frames that visitors of one role asked for, each until when."""

    def __init__(self, each_max: int) -> None:
        self._each_max = each_max
        self._until_ns: dict[Visitor, dict[str, int]] = {}

    def frames(self) -> dict[str, None]:
        """Return all followed frames, of all roles."""
        return dict.fromkeys(chain.from_iterable(self._until_ns.values()))

    def ask(self, frame: str, until_ns: int, visitor: Visitor) -> str:
        """Follow a frame; when full, whoever follows most loses one to whoever follows fewer."""
        own = self._until_ns.get(visitor, {})
        if frame not in own:
            if len(own) >= self._each_max:
                return _TOO_MANY.format(self._each_max)
            if not self._make_room(frame, len(own)):
                return _TOO_MANY.format(FOLLOWED_MAX)
        self._until_ns.setdefault(visitor, own)[frame] = until_ns
        return ""

    def forget(self, now_ns: int) -> None:
        """Stop following frames that nobody has asked for recently."""
        for visitor, own in tuple(self._until_ns.items()):
            left = {frame: until_ns for frame, until_ns in own.items() if until_ns > now_ns}
            self._until_ns[visitor] = left
            if not left:
                del self._until_ns[visitor]

    def _make_room(self, frame: str, own_count: int) -> bool:
        while frame not in (all_of_them := self.frames()) and len(all_of_them) >= FOLLOWED_MAX:
            greediest = max(self._until_ns.values(), key=len)
            if len(greediest) <= own_count + 1:
                return False
            del greediest[next(iter(greediest))]
        return True


class FollowedFrames:
    """Keeps an empty group in the scene at each followed frame, at the cost of one pose."""

    def __init__(self, scene: DrawsLive) -> None:
        self._scene = scene
        self._asked = {
            True: _Asked(FOLLOWED_MAX),
            False: _Asked(FOLLOWED_BY_VIEWER_MAX),
        }
        self._drawn: tuple[str, ...] = ()

    def ask(self, frame: str, now_ns: int, visitor: Visitor) -> str:
        """Follow a frame for a while; return why it cannot be, or an empty text."""
        return self._asked[visitor.role is Role.PRESENTER].ask(
            frame, now_ns + FOLLOWED_FOR_NS, visitor
        )

    def step(self, lookup: Lookup, now_ns: int) -> None:
        """Put each where its frame is now; one that is nowhere stays where it was."""
        for asked in self._asked.values():
            asked.forget(now_ns)
        wanted = tuple(dict.fromkeys(chain(*(one.frames() for one in self._asked.values()))))
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
