"""HistoryDisplay: the base of displays that draw the last messages of one topic."""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from typing import TYPE_CHECKING, ClassVar, Generic, NamedTuple, TypeVar

from studio.displays.display import Status, StillDisplay, reading_fields
from studio.displays.drawing import NOTHING, Placed
from studio.errors import StudioError

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
    """A message that is kept, as content."""

    frame: str
    stamp_ns: int
    content: Content


class _Kept(NamedTuple, Generic[Content]):
    path: str
    entry: Entry[Content]


class HistoryDisplay(StillDisplay, Generic[Content]):
    """Keeps the last messages, each drawn in its own frame at its own stamp.

    Derived classes read a message into an `Entry` and make shapes of its content. While they read
    it they `warn` about it, or `refuse` it.
    """

    KEEPS: ClassVar[str] = ""
    """The property with the number of messages kept; empty keeps the newest alone."""

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._kept: deque[_Kept[Content]] = deque()
        self._free: list[str] = []
        self._points = 0
        self._too_many_points = False
        self._groups: dict[str, Mapping[str, Placed]] = {}
        self._remarks: tuple[Status, ...] = ()

    def take(self, received: Received, role: str = "") -> None:
        """Take in a message; one that cannot be drawn leaves what was drawn before.

        Raises:
            StudioError: It cannot be read.
        """
        del role
        before, self._remarks = self._remarks, ()
        try:
            with reading_fields(received.type_name):
                entry = self.read(received)
        except StudioError:
            self._remarks = before
            raise
        if entry is not None:
            self._keep(entry)

    @abstractmethod
    def read(self, received: Received) -> Entry[Content] | None:
        """Return what to keep of a message; None leaves everything as it is.

        Raises:
            StudioError: It cannot be read.
        """

    @abstractmethod
    def shapes(self, content: Content) -> Mapping[str, Shape]:
        """Return the shapes of a content, with the properties as they are set."""

    def groups(self, entry: Entry[Content]) -> Mapping[str, Placed]:
        """Return the groups of a message by their names below its path; "" is the path itself."""
        return {"": self.placed(entry, self.shapes(entry.content))}

    def points_in(self, content: Content) -> int:
        """Return how many points a message holds; the limits of the display count them."""
        del content
        return 1

    def sizes(self) -> tuple[str, ...]:
        """Return the properties that give a size; where all are 0 a message may be invisible."""
        return ()

    def placed(self, entry: Entry[Content], shapes: Mapping[str, Shape]) -> Placed:
        """Place the shapes of a message."""
        return Placed(entry.frame, entry.stamp_ns, shapes)

    def refuse(self, reason: Reason, sentence: str) -> None:
        """Report why the newest message cannot be drawn; `read` then returns None."""
        self._remarks = (Status("error", reason, sentence),)

    def thin(self, sentence: str) -> None:
        """Report how much of the newest message is drawn."""
        self._remarks = (*self._remarks, Status("ok", "thinned", sentence))

    def warn(
        self, reason: Reason | None, sentence: str, mend: tuple[str, Value] | None = None
    ) -> None:
        """Report what is odd about the newest message, or why not all of it is seen."""
        self._remarks = (*self._remarks, Status("warn", reason, sentence, mend))

    def changed(self, name: str) -> None:
        """Draw again, with the new value."""
        self._groups.clear()
        self._drop_oldest()
        super().changed(name)

    def reset(self) -> None:
        """Forget all messages."""
        self._kept.clear()
        self._free.clear()
        self._points, self._too_many_points = 0, False
        self._groups.clear()
        self._remarks = ()
        super().reset()

    def statuses(self) -> tuple[Status, ...]:
        """Return the remarks on the newest message, and what is transparent or of no size."""
        return (*self._remarks, *self._crowded(), *self.transparent(), *self._of_no_size())

    def _crowded(self) -> tuple[Status, ...]:
        """Return a status if fewer messages are kept than were asked for."""
        if not self._too_many_points:
            return ()
        sentence = (
            f"Showing the newest {len(self._kept):,} messages: with those before them there would "
            f"be more than {self.limits.points:,} points."
        )
        return (Status("ok", "thinned", sentence),)

    def transparent(self) -> tuple[Status, ...]:
        """Return one status for each opacity that is 0 and has an effect."""
        clear = (one for one in self.PROPERTIES if self._is_clear(one) and self._counts(one))
        return tuple(
            Status(
                "warn", "transparent", f"{one.name} is 0, so nothing of it is seen: raise it.",
                (one.name, one.default),
            )
            for one in clear
        )  # fmt: skip

    def _of_no_size(self) -> tuple[Status, ...]:
        """Return a status if nothing of the newest message is seen because its sizes are 0."""
        newest, names = self.newest, self.sizes()
        if newest is None or not names or any(map(self.number, names)):
            return ()
        if self.shapes(newest.content):
            return ()
        are = "is" if len(names) == 1 else "are"
        sentence = f"{' and '.join(names)} {are} 0, so nothing of it is seen: raise {names[0]}."
        mend = (names[0], self._property(names[0]).default)
        return (Status("warn", "empty", sentence, mend),)

    def number(self, name: str) -> float:
        """Return the value of a property that is a number."""
        return float(self.values[name])

    def _is_clear(self, one: Property) -> bool:
        return one.name.lower().endswith("alpha") and self.values[one.name] == 0

    def _counts(self, one: Property) -> bool:
        """Whether a property has an effect with the values of the others."""
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
        """The entry of the newest message that was kept."""
        return self._kept[-1].entry if self._kept else None

    def _keep(self, entry: Entry[Content]) -> None:
        self._points += self.points_in(entry.content)
        self._too_many_points = False
        self._drop_oldest(room_for=1)
        # The path of a dropped message is used again, so that the scene updates its shapes.
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
