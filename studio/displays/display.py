"""The base of all displays: its settings, the topics it subscribes to, its drawing and statuses."""

from __future__ import annotations

from abc import ABC, abstractmethod
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar, Final, Literal, NamedTuple, TypeAlias

from studio.displays.drawing import NOTHING, Drawing
from studio.displays.properties import UPDATE_INTERVAL
from studio.errors import DisplayMessageError, DisplayPropertyError
from studio.ros.cdr import codec_of
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping, Sequence

    from studio.displays.posed_robot import PosedRobot
    from studio.displays.properties import Property, Value
    from studio.displays.selection import Fact, Item, Picked
    from studio.ros.cdr import Codec
    from studio.ros.types.library import TypeLibrary
    from studio.tf.frames import FramesNow

Reason: TypeAlias = Literal[
    "no_points", "not_finite", "out_of_range", "transparent", "empty", "bad_message",
    "no_mesh", "unknown_field", "no_camera_info", "no_picture", "unsupported", "thinned",
    "not_connected_frame", "unknown_joint", "other_robot", "plugin", "distorted",
    "not_here", "no_server",
]  # fmt: skip
"""Why nothing, or not everything, is seen, as far as the display itself knows."""
_TRANSPORTS: Final = {"compressed", "compressedDepth", "ffmpeg", "theora", "zstd"}


@dataclass(frozen=True, slots=True)
class Limits:
    """At most so much of one display.

    Attributes:
        points: Of a cloud, with those of before that have not decayed.
        messages: Of before that have not decayed.
        kept_bytes: Of their messages.
        cells: Of a map.
        pixels: Of a camera's picture.
    """

    points: int = 300_000
    messages: int = 200
    kept_bytes: int = 256 << 20
    cells: int = 16_000_000
    pixels: int = 400_000


class Received(NamedTuple):
    """One message as it was received."""

    type_name: str
    """As `sensor_msgs/msg/LaserScan`."""
    cdr: bytes | memoryview
    """With its header of four bytes."""
    received_ns: int
    """Since the epoch, by the clock of this machine."""


@dataclass(frozen=True, slots=True)
class TopicRole:
    """One of the topics that a display subscribes to.

    Attributes:
        name: The role's: empty for the main topic; else as `updates`, with a topic by `beside`.
        types: Of messages that it takes.
        beside: Suffix to the name of the main topic, as `_updates`; a leading slash replaces the
            last part of that name, as `/camera_info`.
        elsewhere: The topic itself, when it is not beside the main one.
        transport: How a picture is packed, as `compressed`: the last part of its topic.
        newest_only: Whether only the newest message counts; else every one does.
        reliable: Whether the first subscription asks for reliable delivery.
        latched: Whether the first subscription is transient local: it asks for earlier messages.
        depth: Number of messages kept for a display that is slow.
        chosen_reliable: Reliability that a property of the display chooses; None: as fits.
    """

    name: str
    types: tuple[str, ...]
    beside: str = ""
    newest_only: bool = True
    reliable: bool = True
    latched: bool = False
    depth: int = 5
    elsewhere: str = ""
    transport: str = ""
    chosen_reliable: bool | None = None

    def topic(self, main: str) -> str:
        """Return the topic of this role beside a main one.

        Pictures of a transport are one name deeper, as `/camera/image/compressed`; the topic is
        beside the picture itself.
        """
        if self.elsewhere or self.transport:
            base = self.elsewhere or main
            packed = not self.transport or base.rpartition("/")[2] in _TRANSPORTS
            return base if packed else f"{base}/{self.transport}"
        if not self.beside.startswith("/"):
            return main + self.beside
        above, _, last = main.rpartition("/")
        if last in _TRANSPORTS:
            above = above.rpartition("/")[0]
        return above + self.beside


class Status(NamedTuple):
    """A remark of a display on what it shows."""

    level: Literal["ok", "warn", "error"]
    reason: Reason | None
    sentence: str
    mend: tuple[str, Value] | None = None
    """A property and the value that would make it visible."""


class Display(ABC):
    """One display with its settings; a new one is made when its topic changes.

    All calls come from one thread. A message that cannot be read raises a StudioError, and what
    was drawn before stays.
    """

    KIND: ClassVar[str]
    """RViz's name of the kind, as `LaserScan`."""
    DOC: ClassVar[str]
    """One sentence on what it shows."""
    ICON: ClassVar[str] = "box"
    """One of the page's icons, by its name in `ICONS` of `frontend_assets/tools/vendor.mjs`."""
    TOPICS: ClassVar[tuple[TopicRole, ...]] = ()
    """The main one first; empty for a display without messages."""
    FIRST_TOPIC: ClassVar[str] = ""
    """The topic to subscribe to when none was chosen."""
    OF_TYPES: ClassVar[tuple[str, ...]] = ()
    """Messages that it shows, though others receive them for it."""
    PROPERTIES: ClassVar[tuple[Property, ...]] = ()
    SETTINGS_MAX: ClassVar[int] = 1000
    """Limit of the properties kept; some displays get more with their messages, as links."""

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        self._types = types
        self.topic = ""
        """Its main topic, once it is subscribed to."""
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

    @classmethod
    def settings_for(cls, topic: str) -> Mapping[str, Value]:
        """Return the properties that name a topic, of a display that does not subscribe itself."""
        del topic
        return {}

    def roles(self) -> tuple[TopicRole, ...]:
        """Return the topics to subscribe to with the properties as they are set."""
        return self.TOPICS

    @property
    def interval_ns(self) -> int:
        """How long a drawing keeps its poses, whatever arrives on /tf."""
        return round(float(self.values.get(UPDATE_INTERVAL.name, 0.0)) * 1e9)

    def changed(self, name: str) -> None:
        """React to a new value of a property, or of all of them (empty)."""
        del name

    def properties(self) -> tuple[Property, ...]:
        """Return what can be set now: namespaces of markers, for example, come with messages."""
        return self.PROPERTIES

    def property_named(self, name: str) -> Property:
        """Return a property by its name, also one that messages have yet to bring.

        Raises:
            DisplayPropertyError: There is none.
        """
        return self._property(name)

    def limit(self, limits: Limits) -> None:
        """Apply these limits to all messages from now on."""
        self.limits = limits

    @property
    def wants_frames(self) -> bool:
        """Whether it is told by `see` where all frames are, before each drawing."""
        return False

    def see(self, frames: FramesNow) -> None:
        """Take where all frames are now."""
        del frames

    def beside(self, names: Mapping[str, str], own: str) -> None:
        """Take the names of all displays by their ids, and its own id, before each drawing."""
        del names, own

    def stand(self, robot: PosedRobot) -> None:
        """Take the document's robot as it stands now, before each drawing."""
        del robot

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
        """Return what is seen now, ns since the epoch; unchanged parts are the same objects."""

    def statuses(self) -> tuple[Status, ...]:
        """Return what the user should know; empty when all is well."""
        return ()

    def close(self) -> None:
        """Let go of what it holds: it is taken away, and is asked for nothing more."""
        self._codecs.clear()

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the keys of the items that were pointed at in the last drawing, each once.

        None of a display whose shapes stand for nothing that can be selected, as the lines of a
        grid. A display that has no `item` of its own is selected group by group, by their paths.
        """
        return (picked.path,)

    def item(self, key: str) -> Item | None:
        """Return an item as it is now; None when it is gone, or a group. Keys may be any text."""
        del key
        return None

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return what is known of an item; nothing when it is gone."""
        del key
        return ()

    def decode(self, received: Received) -> Any:  # noqa: ANN401 - of the type that it names
        """Read a message; arrays of numbers are read-only views.

        Raises:
            UnknownTypeError: The type is not known.
            CdrError: The bytes are none of that type.
        """
        codec = self._codecs.get(received.type_name)
        if codec is None:
            codec = codec_of(self._types.message(received.type_name))
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
        """Draw again."""
        del name
        self.redraw()

    def redraw(self) -> None:
        """Drop what was drawn, so that it is drawn again."""
        self._drawing = None

    def draw(self, now_ns: int) -> Drawing:
        """Return the drawing, made again only after `redraw`."""
        del now_ns
        if self._drawing is None:
            self._drawing = self._drawn()
        return self._drawing

    def _drawn(self) -> Drawing:
        return NOTHING


def frame_and_stamp(header: Any) -> tuple[str, int]:  # noqa: ANN401 - a message
    """Return the frame of a std_msgs/Header and its stamp, ns since the epoch."""
    return header.frame_id, header.stamp.sec * NANOSECONDS + header.stamp.nanosec


def stamp_ns_of(header: object) -> int:
    """Return the stamp of a std_msgs/Header, ns since the epoch."""
    stamp = getattr(header, "stamp")  # noqa: B009 - a std_msgs/Header of any distribution
    return int(stamp.sec) * NANOSECONDS + int(stamp.nanosec)


@contextmanager
def reading_fields(type_name: str) -> Generator[None]:
    """Read the fields of a message within this context.

    Raises:
        DisplayMessageError: A field is missing or of another kind, because the type was defined
            here with other fields than in ROS.
    """
    try:
        yield
    except (AttributeError, TypeError, ValueError, IndexError) as error:
        reason = (
            f"it is known here with other fields than ROS gives it ({error}): take back the text "
            "that says so"
        )
        raise DisplayMessageError(type_name, reason) from error
