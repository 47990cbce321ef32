"""HistoryDisplay: the base of displays that draw the last messages of one topic."""

from __future__ import annotations

from abc import abstractmethod
from collections import deque
from typing import TYPE_CHECKING, ClassVar, Final, Generic, NamedTuple, TypeVar

from studio.displays.display import Status, StillDisplay, reading_fields
from studio.displays.drawing import NOTHING, Placed
from studio.displays.selection import NEWEST, Item, box_of, index_of, message_facts
from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from studio.displays.display import Reason, Received
    from studio.displays.drawing import Drawing, Shape, Wxyz, Xyz
    from studio.displays.properties import Property, Value
    from studio.displays.selection import Fact, ItemKind, Picked
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

DECODED_MAX_BYTES: Final = 1 << 18
"""A larger message takes too long to be read as a whole."""
_MESSAGES_MAX_BYTES: Final = 32 << 20
"""Of all messages that are kept as they came."""
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
    number: int
    """Of the message, counted from the first that came."""
    received: Received | None
    """None if it is too large to be kept beside what was read of it."""


class HistoryDisplay(StillDisplay, Generic[Content]):
    """Keeps the last messages, each drawn in its own frame at its own stamp.

    Derived classes read a message into an `Entry` and make shapes of its content. While they read
    it they `warn` about it, or `refuse` it.
    """

    KEEPS: ClassVar[str] = ""
    """The property with the number of messages kept; empty keeps the newest alone."""
    ITEM: ClassVar[ItemKind] = "message"
    """What is selected of it: a whole message, or one of its parts."""

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._kept: deque[_Kept[Content]] = deque()
        self._free: list[str] = []
        self._points = 0
        self._number = 0
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
            self._keep(entry, received)

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

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the keys of messages, or of parts of one."""
        path, _, group = picked.path.partition("/")
        kept = next((one for one in self._kept if one.path == path), None)
        if kept is None:
            return ()
        message = NEWEST if self._kept_max == 1 else str(kept.number)
        parts = self.parts_picked(kept.entry.content, picked._replace(path=group))
        return [f"{message}/{part}" if part else message for part in parts]

    def item(self, key: str) -> Item | None:
        """Return a message that is kept still, or a part of it."""
        kept, part = self._of_key(key)
        if kept is None:
            return None
        if part:
            return self.part_item(kept.entry, kept.path, part)
        entry = kept.entry
        placed = self._groups.get(kept.path, {}).get("")
        box = box_of(placed.shapes) if placed is not None else None
        pose = self.message_pose(entry.content)
        return Item(self.ITEM, "", kept.path, entry.frame, entry.stamp_ns, box, *pose)

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return the fields of a message, or what is known of a part of it."""
        kept, part = self._of_key(key)
        if kept is None:
            return ()
        message = self._message_of(kept)
        if part:
            return self.part_facts(kept.entry.content, part, message)
        return () if message is None else message_facts(message)

    def message_pose(self, content: Content) -> tuple[Xyz | None, Wxyz | None]:
        """Return where a message is in its frame, and how it is turned, as far as it says so."""
        del content
        return None, None

    def parts_picked(self, content: Content, picked: Picked) -> Sequence[str]:
        """Return the names of the parts that were pointed at; an empty one is the whole message.

        The path of `picked` is that of a group of `groups`.
        """
        del content, picked
        return ("",)

    def part_item(self, entry: Entry[Content], path: str, part: str) -> Item | None:
        """Return a part of a message drawn below a path; None if there is none of that name."""
        del entry, path, part

    def part_facts(
        self, content: Content, part: str, message: MessageValue | None
    ) -> tuple[Fact, ...]:
        """Return what is known of a part; the message itself is None if it is a large one."""
        del content, part, message
        return ()

    def _of_key(self, key: str) -> tuple[_Kept[Content] | None, str]:
        number, _, part = key.partition("/")
        if number == NEWEST:
            return (self._kept[-1] if self._kept else None), part
        place = index_of(number) - self._kept[0].number if self._kept else -1
        return (self._kept[place] if 0 <= place < len(self._kept) else None), part

    def _message_of(self, kept: _Kept[Content]) -> MessageValue | None:
        received = kept.received
        if received is None or len(received.cdr) > DECODED_MAX_BYTES:
            return None
        return self.decode(received)

    def _keep(self, entry: Entry[Content], received: Received) -> None:
        self._points += self.points_in(entry.content)
        self._too_many_points = False
        self._drop_oldest(room_for=1)
        # The path of a dropped message is used again, so that the scene updates its shapes.
        path = self._free.pop() if self._free else str(len(self._kept))
        self._number += 1
        is_small = len(received.cdr) <= _MESSAGES_MAX_BYTES // self._kept_max
        self._kept.append(_Kept(path, entry, self._number, received if is_small else None))
        self.redraw()

    def _drop_oldest(self, room_for: int = 0) -> None:
        while len(self._kept) + room_for > self._kept_max:
            self._drop()
        while self._kept and self._points > self.limits.points:
            self._too_many_points = True
            self._drop()

    def _drop(self) -> None:
        path, entry, *_ = self._kept.popleft()
        self._points -= self.points_in(entry.content)
        self._groups.pop(path, None)
        self._free.append(path)

    def _drawn(self) -> Drawing:
        drawn: dict[str, Placed] = {}
        for kept in self._kept:
            path, entry = kept.path, kept.entry
            if path not in self._groups:
                self._groups[path] = self.groups(entry)
            for name, placed in self._groups[path].items():
                if placed.shapes:
                    drawn[f"{path}/{name}" if name else path] = placed
        return drawn or NOTHING
