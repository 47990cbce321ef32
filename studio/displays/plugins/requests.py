"""Messages between the studio and the process of a plug-in, packed alike at both ends."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final

from studio.displays.properties import Value  # noqa: TC001 - msgspec reads it
from studio.worker_process import Codec


@dataclass(frozen=True, slots=True)
class Describe:
    """Load the plug-in, and say what it is.

    Attributes:
        path: The file.
        texts: Definitions of message types that came from the user's packages, by name.
    """

    path: str
    texts: dict[str, str]


@dataclass(frozen=True, slots=True)
class PackedRole:
    """A TopicRole, as far as a plug-in may choose."""

    name: str
    types: tuple[str, ...]
    beside: str
    newest_only: bool
    reliable: bool
    latched: bool
    depth: int
    elsewhere: str


@dataclass(frozen=True, slots=True)
class PackedProperty:
    """A Property; its bounds are None where there are none."""

    name: str
    kind: str
    default: Value
    doc: str
    low: float | None
    high: float | None
    unit: str
    choices: tuple[str, ...]
    when: tuple[str, tuple[Value, ...]] | None


@dataclass(frozen=True, slots=True)
class Described:
    """What a plug-in is: the class variables of its display."""

    kind: str
    doc: str
    icon: str
    first_topic: str
    topics: tuple[PackedRole, ...]
    properties: tuple[PackedProperty, ...]


@dataclass(frozen=True, slots=True)
class Came:
    """A message that was received, as `Received`, and on the topic of which role."""

    role: str
    type_name: str
    cdr: bytes
    received_ns: int


@dataclass(frozen=True, slots=True)
class Step:
    """Have one display take in what came, and draw.

    Attributes:
        display: Its number; a new one is made at its first step.
        values: All its properties, if they changed.
        reset: Whether it forgets what it took before.
        came: Messages.
        now_ns: Since the epoch.
        gone: Numbers of displays that are no more.
        texts: Definitions of message types that it has not been sent yet.
    """

    display: int
    values: dict[str, Value] | None
    reset: bool
    came: tuple[Came, ...]
    now_ns: int
    gone: tuple[int, ...] = ()
    texts: dict[str, str] = field(default_factory=dict[str, str])


@dataclass(frozen=True, slots=True)
class PackedShape:
    """A shape by a number of its own; arrays are of their type, their shape and their bytes."""

    number: int
    kind: str
    fields: dict[str, Any]


@dataclass(frozen=True, slots=True)
class PackedGroup:
    """A Placed: its shapes by name are numbers of PackedShapes, of this drawing or before."""

    path: str
    frame: str
    stamp_ns: int
    follows: bool
    turns: bool
    offset: tuple[float, ...] | None
    shapes: dict[str, int]


@dataclass(frozen=True, slots=True)
class PackedStatus:
    """A Status."""

    level: str
    sentence: str
    mend: tuple[str, Value] | None


@dataclass(frozen=True, slots=True)
class Drawn:
    """What a display draws.

    Attributes:
        groups: All of it; None: the same as before.
        shapes: Those that are new.
        statuses: What it says of itself.
        refused: Why messages could not be read, the last one; empty: they could.
        roles: The topics that it wants now.
        more: Properties beside those of its kind.
    """

    groups: tuple[PackedGroup, ...] | None
    shapes: tuple[PackedShape, ...]
    statuses: tuple[PackedStatus, ...]
    refused: str
    roles: tuple[PackedRole, ...]
    more: tuple[PackedProperty, ...]


@dataclass(frozen=True, slots=True)
class Failed:
    """The plug-in raised, or is none; what, and where in its file."""

    sentence: str


CODEC: Final = Codec(Describe, Described, Step, Drawn, Failed)
