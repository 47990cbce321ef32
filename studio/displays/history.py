"""HistoryDisplay: a display of one topic that keeps what its last messages say."""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, TypeVar

from studio.displays.display import Status, StillDisplay
from studio.displays.drawing import NOTHING, Placed
from studio.displays.reading import reading
from studio.errors import StudioError
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.display import Reason, Received
    from studio.displays.drawing import Drawing, Shape
    from studio.displays.properties import Property, Value
    from studio.ros.types.library import TypeLibrary

KEPT_MAX = 2_000
"""Messages kept at most: each has a place of its own in the scene, and up to four shapes."""

Content = TypeVar("Content")


class Entry(NamedTuple, Generic[Content]):
    """What is kept of a message."""

    frame: str
    stamp_ns: int
    content: Content


class _Kept(NamedTuple, Generic[Content]):
    path: str
    entry: Entry[Content]


class HistoryDisplay(StillDisplay, Generic[Content]):
    """Keeps the last messages, each drawn in its own frame at its own stamp.

    Derived classes read a message into an `Entry` and make shapes of its content. What is to be
    said of the newest message they `warn` or `refuse` while they read it.
    """

    KEEPS: ClassVar[str] = ""
    """The property that says how many messages are kept; empty keeps the newest alone."""

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._kept: deque[_Kept[Content]] = deque()
        self._free: list[str] = []
        self._points = 0
        self._too_many_points = False
        self._groups: dict[str, Mapping[str, Placed]] = {}
        self._told: tuple[Status, ...] = ()

    def take(self, received: Received, role: str = "") -> None:
        """Take in a message; one that cannot be drawn leaves what was drawn before.

        Raises:
            StudioError: It cannot be read.
        """
        del role
        before, self._told = self._told, ()
        try:
            with reading(received.type_name):
                entry = self.read(received)
        except StudioError:
            self._told = before
            raise
        if entry is not None:
            self._keep(entry)

    @abstractmethod
    def read(self, received: Received) -> Entry[Content] | None:
        """What is kept of a message; None leaves all as it is.

        Raises:
            StudioError: It cannot be read.
        """

    @abstractmethod
    def shapes(self, content: Content) -> Mapping[str, Shape]:
        """What is seen of a content with the properties as they are."""

    def groups(self, entry: Entry[Content]) -> Mapping[str, Placed]:
        """What is seen of a message, by names below its path; most have one without a name."""
        return {"": self.placed(entry, self.shapes(entry.content))}

    def points_in(self, content: Content) -> int:
        """How many points a message holds, of which a display shows no more than its limits say."""
        del content
        return 1

    def sizes(self) -> tuple[str, ...]:
        """Measures of what is drawn, by name; where all are 0 nothing may be seen of a message."""
        return ()

    def placed(self, entry: Entry[Content], shapes: Mapping[str, Shape]) -> Placed:
        """Where the shapes of a message are."""
        return Placed(entry.frame, entry.stamp_ns, shapes)

    def refuse(self, reason: Reason, sentence: str) -> None:
        """Say of the newest message why it cannot be drawn: `read` gives None then."""
        self._told = (Status("error", reason, sentence),)

    def thin(self, sentence: str) -> None:
        """Say of the newest message how much of it is drawn."""
        self._told = (*self._told, Status("ok", "thinned", sentence))

    def warn(
        self, reason: Reason | None, sentence: str, mend: tuple[str, Value] | None = None
    ) -> None:
        """Say of the newest message what is odd, or why not all of it is seen."""
        self._told = (*self._told, Status("warn", reason, sentence, mend))

    def changed(self, name: str) -> None:
        """Draw anew, with the new value."""
        self._groups.clear()
        self._drop_oldest()
        super().changed(name)

    def reset(self) -> None:
        """Forget all messages."""
        self._kept.clear()
        self._free.clear()
        self._points, self._too_many_points = 0, False
        self._groups.clear()
        self._told = ()
        super().reset()

    def statuses(self) -> tuple[Status, ...]:
        """What is to be said of the newest message, and what is transparent or of no size."""
        return (*self._told, *self._crowded(), *self.transparent(), *self._of_no_size())

    def _crowded(self) -> tuple[Status, ...]:
        """That fewer messages are kept than are wished."""
        if not self._too_many_points:
            return ()
        sentence = (
            f"Showing the newest {len(self._kept):,} messages: with those before them there would "
            f"be more than {self.limits.points:,} points."
        )
        return (Status("ok", "thinned", sentence),)

    def transparent(self) -> tuple[Status, ...]:
        """One status for each opacity that is 0 and counts."""
        clear = (one for one in self.PROPERTIES if self._is_clear(one) and self._counts(one))
        return tuple(
            Status(
                "warn", "transparent", f"{one.name} is 0, so nothing of it is seen: raise it.",
                (one.name, one.default),
            )
            for one in clear
        )  # fmt: skip

    def _of_no_size(self) -> tuple[Status, ...]:
        """That nothing of the newest message is seen since its measures are set to 0."""
        newest, names = self.newest, self.sizes()
        if newest is None or not names or any(map(self.number, names)):
            return ()
        if self.shapes(newest.content):
            return ()
        are = "is" if len(names) == 1 else "are"
        words = f"{' and '.join(names)} {are} 0, so nothing of it is seen: raise {names[0]}."
        mend = (names[0], self._property(names[0]).default)
        return (Status("warn", "empty", words, mend),)

    def number(self, name: str) -> float:
        """The value of a property that is a number."""
        return float(self.values[name])

    def _is_clear(self, one: Property) -> bool:
        return one.name.lower().endswith("alpha") and self.values[one.name] == 0

    def _counts(self, one: Property) -> bool:
        """Whether a property means something with the values of the others."""
        if one.when is None:
            return True
        name, values = one.when
        return self.values[name] in values and self._counts(self._property(name))

    @property
    def _kept_max(self) -> int:
        if not self.KEEPS:
            return 1
        wanted = int(self.values[self.KEEPS])
        return min(wanted, KEPT_MAX) if wanted > 0 else KEPT_MAX

    @property
    def newest(self) -> Entry[Content] | None:
        """What was kept last."""
        return self._kept[-1].entry if self._kept else None

    def _keep(self, entry: Entry[Content]) -> None:
        self._points += self.points_in(entry.content)
        self._too_many_points = False
        self._drop_oldest(room_for=1)
        # The path of what was dropped is taken again: there its shapes are updated, not made anew.
        path = self._free.pop() if self._free else str(len(self._kept))
        self._kept.append(_Kept(path, entry))
        self.redraw()

    def _drop_oldest(self, room_for: int = 0) -> None:
        while len(self._kept) + room_for > self._kept_max:
            self._drop()
        while self._kept and self._points > self.limits.points:
            self._too_many_points = True
            self._drop()

    def _drop(self) -> None:
        path, entry = self._kept.popleft()
        self._points -= self.points_in(entry.content)
        self._groups.pop(path, None)
        self._free.append(path)

    def _drawn(self) -> Drawing:
        drawn: dict[str, Placed] = {}
        for path, entry in self._kept:
            if path not in self._groups:
                self._groups[path] = self.groups(entry)
            for name, placed in self._groups[path].items():
                if placed.shapes:
                    drawn[f"{path}/{name}" if name else path] = placed
        return drawn or NOTHING


def frame_and_stamp(header: Any) -> tuple[str, int]:  # noqa: ANN401 - a message
    """The frame of a std_msgs/Header and its stamp, ns since the epoch."""
    return header.frame_id, header.stamp.sec * NANOSECONDS + header.stamp.nanosec
