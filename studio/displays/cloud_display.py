"""Display of clouds: what scans and point clouds share, from the message to what still is seen."""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar, Final

from studio.displays.cloud_look import (
    LOOK,
    POINTS_AT_MOST,
    POINTS_LIMIT,
    colours_of,
    needs_precision,
    points_of,
    too_many_bodies,
)
from studio.displays.display import Display, Status
from studio.displays.drawing import NOTHING, Drawing, Placed
from studio.displays.reading import reading

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from studio.displays.cloud import Cloud
    from studio.displays.display import Received
    from studio.displays.limits import Limits
    from studio.displays.properties import Property, Value
    from studio.ros.types.library import TypeLibrary


_SIZE: Final = "Size (m)"
_WITHOUT_COLOUR: Final = {"Style", _SIZE, "Size (Pixels)", "Alpha", "Decay Time", POINTS_AT_MOST}


@dataclass(slots=True, eq=False)
class _Kept:
    """A message that is seen, where it is drawn, and how it was drawn last."""

    path: str
    received: Received
    cloud: Cloud
    colours: NDArray[np.uint8] | None = None
    placed: Placed | None = None
    said: Status | None = None


class CloudDisplay(Display):
    """Keeps the newest cloud, and those before it until they decayed; derived classes read one."""

    PROPERTIES: ClassVar[tuple[Property, ...]] = LOOK

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._kept: deque[_Kept] = deque()
        self._left_out = 0
        self._precise = False
        self._drawing: Drawing | None = NOTHING

    @abstractmethod
    def read(self, received: Received, limits: Limits) -> Cloud:
        """The cloud of a message.

        Raises:
            StudioError: It cannot be read, or makes no sense.
        """

    def take(self, received: Received, role: str = "") -> None:
        """Take in a message; how long it is seen, the decay time says."""
        del role
        with reading(received.type_name):
            cloud = self.read(received, self.limits)
        if not self._decay_ns():
            self._kept.clear()
        self._decay(received.received_ns)
        self._kept.append(_Kept(self._free_path(), received, cloud))
        self._hold_limits()
        self._drawing = None

    def changed(self, name: str) -> None:
        """Look different from now on."""
        if name == "Decay Time" and not self._decay_ns():
            self._keep_newest()
        if name == POINTS_AT_MOST:
            self._read_anew(int(self.values[name]))
        if name in ("", _SIZE):
            self._precise = False
        for one in self._kept:
            one.placed = None
            if name not in _WITHOUT_COLOUR:
                one.colours = None
        self._drawing = None

    def reset(self) -> None:
        """Forget all clouds."""
        self._kept.clear()
        self._left_out = 0
        self._precise = False
        self._drawing = NOTHING

    def draw(self, now_ns: int) -> Drawing:
        """The clouds that have not decayed now."""
        if self._decay_ns():
            self._decay(now_ns)
        if self._drawing is None:
            self._drawing = {
                one.path: placed for one in self._kept if (placed := self._placed(one)) is not None
            }
        return self._drawing

    def statuses(self) -> tuple[Status, ...]:
        """What is to be said of the newest cloud, and what is left out."""
        if not self._kept:
            return ()
        newest = self._kept[-1]
        bodies = too_many_bodies(newest.cloud.count, self.values)
        found = [newest.cloud.nothing, newest.said, self._transparent(), *self._thinned(), bodies]
        return tuple(one for one in found if one is not None)

    def _placed(self, one: _Kept) -> Placed | None:
        if not one.cloud.count:
            return None
        if one.placed is None:
            if one.colours is None:
                one.colours, one.said = colours_of(one.cloud, self.values)
            # Once asked for it stays: a cloud that reaches now here, now there would be sent anew.
            self._precise |= needs_precision(one.cloud.positions, float(self.values[_SIZE]))
            shape = points_of(one.cloud, one.colours, self.values, precise=self._precise)
            cloud = one.cloud
            one.placed = Placed(cloud.frame, cloud.stamp_ns, {"points": shape}, sweep=cloud.sweep)
        return one.placed

    def _decay_ns(self) -> int:
        return int(float(self.values["Decay Time"]) * 1e9)

    def _decay(self, now_ns: int) -> None:
        """Drop what came longer ago than the decay time."""
        decay_ns = self._decay_ns()
        while self._kept and now_ns - self._kept[0].received.received_ns > decay_ns:
            self._kept.popleft()
            self._drawing = None

    def _keep_newest(self) -> None:
        while len(self._kept) > 1:
            self._kept.popleft()
        self._left_out = 0

    def _hold_limits(self) -> None:
        """Drop the oldest of what is more than may be shown; the newest stays."""
        count = sum(one.cloud.count for one in self._kept)
        size_bytes = sum(one.cloud.channels.size_bytes for one in self._kept)
        self._left_out = 0
        while len(self._kept) > 1 and (
            count > self.limits.points
            or size_bytes > self.limits.kept_bytes
            or len(self._kept) > self.limits.messages
        ):
            dropped = self._kept.popleft().cloud
            count, size_bytes = count - dropped.count, size_bytes - dropped.channels.size_bytes
            self._left_out += 1

    def _read_anew(self, points: int) -> None:
        """Show another number of points, also of what came before: a map may come only once."""
        self.limit(replace(self.limits, points=points))
        for one in self._kept:
            one.cloud, one.colours = self.read(one.received, self.limits), None
        self._hold_limits()

    def _free_path(self) -> str:
        """A path is used again, so that what is there is changed and not made anew."""
        taken = {one.path for one in self._kept}
        return next(str(n) for n in range(len(taken) + 1) if str(n) not in taken)

    def _transparent(self) -> Status | None:
        if float(self.values["Alpha"]) > 0.0:
            return None
        return Status("warn", "transparent", "Alpha is 0: nothing is seen.", ("Alpha", 1.0))

    def _thinned(self) -> list[Status]:
        found: list[Status] = []
        cloud = self._kept[-1].cloud
        if cloud.count < cloud.available:
            sentence = f"Showing {cloud.count:,} of {cloud.available:,} points."
            mend = (POINTS_AT_MOST, min(cloud.available, POINTS_LIMIT))
            found.append(Status("ok", "thinned", sentence, mend))
        if self._left_out:
            sentence = (
                f"Showing the newest {len(self._kept):,} messages: with those before them there "
                f"would be more than {self.limits.points:,} points."
            )
            found.append(Status("ok", "thinned", sentence))
        return found
