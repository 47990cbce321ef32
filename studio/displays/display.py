"""Display: takes the messages of its topics and keeps what is to be seen of them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, NamedTuple, TypeAlias

from studio.displays.drawing import NOTHING, Drawing
from studio.displays.limits import Limits
from studio.displays.properties import UPDATE_INTERVAL
from studio.errors import DisplayPropertyError
from studio.ros.cdr import Codec

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.properties import Property, Value
    from studio.ros.types.library import TypeLibrary

Reason: TypeAlias = Literal[
    "no_points", "not_finite", "out_of_range", "transparent", "empty", "bad_message",
    "no_mesh", "unknown_field", "no_camera_info", "unsupported", "thinned", "not_connected_frame",
]  # fmt: skip
"""Why nothing, or not everything, is seen, as far as the display itself can know."""

_TRANSPORTS: Final = {"compressed", "compressedDepth", "ffmpeg", "theora", "zstd"}


class Received(NamedTuple):
    """One message as it came."""

    type_name: str
    """As `sensor_msgs/msg/LaserScan`."""
    cdr: bytes | memoryview
    """With its header of four bytes."""
    received_ns: int
    """Since the epoch, by the clock of this machine."""


@dataclass(frozen=True, slots=True)
class TopicRole:
    """One of the topics that a display listens to.

    Attributes:
        name: Of the role: empty for the main one; else as `updates`, and the topic is beside it.
        types: Of messages that it takes.
        beside: What follows the name of the main topic, as `_updates`; with a leading slash the
            last part of the main topic's name is replaced, as by `/camera_info`.
        newest_only: Whether only the newest message counts; else every one does.
        reliable: Whether messages are asked for reliably at first.
        latched: Whether messages from before are asked for at first.
        depth: How many are kept for a display that is late.
    """

    name: str
    types: tuple[str, ...]
    beside: str = ""
    newest_only: bool = True
    reliable: bool = True
    latched: bool = False
    depth: int = 5

    def topic(self, main: str) -> str:
        """The topic of this role beside a main one.

        Pictures of a transport lie one name deeper, as `/camera/image/compressed`: what is beside
        the picture is meant.
        """
        if not self.beside.startswith("/"):
            return main + self.beside
        above, _, last = main.rpartition("/")
        if last in _TRANSPORTS:
            above = above.rpartition("/")[0]
        return above + self.beside


class Status(NamedTuple):
    """What a display has to say of what it shows."""

    level: Literal["ok", "warn", "error"]
    reason: Reason | None
    sentence: str
    mend: tuple[str, Value] | None = None
    """A property and the value that would show it."""


class Display(ABC):
    """One display with its settings; made anew when its topic changes.

    All calls come from one thread. A message that cannot be read raises a StudioError, and what
    was drawn before stays.
    """

    KIND: ClassVar[str]
    """RViz's name of the kind, as `LaserScan`."""
    DOC: ClassVar[str]
    """One sentence on what it shows."""
    TOPICS: ClassVar[tuple[TopicRole, ...]] = ()
    """The main one first; empty for a display without messages."""
    FIRST_TOPIC: ClassVar[str] = ""
    """What is listened to when nobody chose a topic."""
    PROPERTIES: ClassVar[tuple[Property, ...]] = ()
    SETTINGS_MAX: ClassVar[int] = 1000
    """How many properties are kept: some displays have more with what comes, as links."""

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        self._types = types
        self._codecs: dict[str, Codec] = {}
        self.limits = Limits()
        self.values: dict[str, Value] = {one.name: one.default for one in self.PROPERTIES}
        for name, value in (values or {}).items():
            self.values[name] = self._property(name).checked(value)

    def set(self, name: str, value: object) -> None:
        """Change a property.

        Raises:
            DisplayPropertyError: There is none of that name, or the value is of another kind, or
                it is one too many.
        """
        if name not in self.values and len(self.values) >= self.SETTINGS_MAX:
            reason = f"is one too many: {self.SETTINGS_MAX:,} properties can be set"
            raise DisplayPropertyError(name, reason, None)
        self.values[name] = self._property(name).checked(value)
        self.changed(name)

    def roles(self) -> tuple[TopicRole, ...]:
        """What it listens to as it is set now."""
        return self.TOPICS

    @property
    def interval_ns(self) -> int:
        """How long what is drawn stays where it is, whatever /tf tells."""
        return round(float(self.values.get(UPDATE_INTERVAL.name, 0.0)) * 1e9)

    def changed(self, name: str) -> None:
        """A property has another value, or all (empty): what was drawn may look different."""
        del name

    def properties(self) -> tuple[Property, ...]:
        """What can be set now: of some displays more than at first, as namespaces of markers."""
        return self.PROPERTIES

    def limit(self, limits: Limits) -> None:
        """Show at most so much of what comes from now on."""
        self.limits = limits

    def take(self, received: Received, role: str = "") -> None:
        """Take in a message of one of the topics.

        Raises:
            StudioError: It cannot be read.
        """
        del received, role

    def reset(self) -> None:
        """Forget all messages: time jumped, or the topic is another."""
        self.changed("")

    @abstractmethod
    def draw(self, now_ns: int) -> Drawing:
        """What is to be seen now, ns since the epoch: unchanged parts are the same objects."""

    def statuses(self) -> tuple[Status, ...]:
        """What is to be said of it; empty when all is well."""
        return ()

    def decode(self, received: Received) -> Any:  # noqa: ANN401 - of the type that it names
        """Read a message; arrays of numbers are read-only views.

        Raises:
            UnknownTypeError: The type is not known.
            CdrError: The bytes are none of that type.
        """
        codec = self._codecs.get(received.type_name)
        if codec is None:
            codec = Codec(self._types.message(received.type_name))
            self._codecs[received.type_name] = codec
        return codec.decode(received.cdr)

    def _property(self, name: str) -> Property:
        for one in self.PROPERTIES:
            if one.name == name:
                return one
        raise DisplayPropertyError(name, f"is no property of {self.KIND}", None)


class StillDisplay(Display):
    """A display that draws the same until a property or a message changes it.

    Derived classes implement `_drawn`, and call `redraw` after they took a message.
    """

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._drawing: Drawing | None = None

    def changed(self, name: str) -> None:
        """Draw anew."""
        del name
        self.redraw()

    def redraw(self) -> None:
        """What was drawn does not hold any more."""
        self._drawing = None

    def draw(self, now_ns: int) -> Drawing:
        """What is to be seen."""
        del now_ns
        if self._drawing is None:
            self._drawing = self._drawn()
        return self._drawing

    def _drawn(self) -> Drawing:
        return NOTHING
