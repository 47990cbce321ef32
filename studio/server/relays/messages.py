"""What origin and relay say to each other; all of it goes through one stream each way, in order.

A lane is a snapshot and the frames after it, as the bytes that pages get: `""` is the lane of what
every page is sent, whatever it shows, those of documents have their ids, and those that begin with
`!` are of what pages follow: `!changes graph`, `!operations goals`.
"""

from __future__ import annotations

from typing import Annotated, Final, TypeAlias, cast

import msgspec

from studio.errors import RelayLineError
from studio.server.relays.tickets import TICKET_LETTERS_MAX

STUDIO_LANE: Final = ""
VIEWER: Final = "viewer-"
"""Before the id of people who look on and are kept in no list: the class is full."""
MOMENT: Final = "!"
"""Key of what is told of a moment, and to nobody who comes later."""
CHANGES, OPERATIONS = "!changes ", "!operations "
UP_BYTES_MAX: Final = 4 << 20
"""Of a message of a relay; the largest is a command."""
_COUNT_MAX: Final = 100_000

NAME_LETTERS_MAX: Final = 300
Name: TypeAlias = Annotated[str, msgspec.Meta(max_length=NAME_LETTERS_MAX)]
"""Of a document, a lane, a person."""
TicketText: TypeAlias = Annotated[str, msgspec.Meta(max_length=TICKET_LETTERS_MAX)]
Number: TypeAlias = Annotated[int, msgspec.Meta(ge=0, le=1 << 62)]
Count: TypeAlias = Annotated[int, msgspec.Meta(ge=0, le=_COUNT_MAX)]
Typed: TypeAlias = Annotated[str, msgspec.Meta(max_length=400)]
"""By a person, into the form to join."""


class Claim(msgspec.Struct, frozen=True):
    """An origin asks a relay to serve its room."""

    version: str
    """Of the studio: both sides have the same, for pages of one speak with the other."""
    room: str
    public: bytes
    """Of the room's identity, whose digest the room's name is."""
    handshake: bytes
    session: str
    relay: bytes = b""
    """Digest of the relay's key: another relay that was shown the claim could pass it on."""
    dial: str = ""
    """The address that was dialled; by two of them a studio does not come at once."""


class ClaimAnswer(msgspec.Struct, frozen=True):
    """The relay serves it on a line of that name; or does not, for a reason."""

    line: str = ""
    handshake: bytes = b""
    address: str = ""
    """Of the room's page at this relay."""
    reason: str = ""


class Signed(msgspec.Struct, frozen=True):
    """A claim or its answer, with the proof who made it."""

    body: bytes
    signature: bytes


class Frame(msgspec.Struct, frozen=True, array_like=True):
    """One message for pages, as it goes onto their control lane; of one `key` the newest counts."""

    data: bytes
    binary: bool = False
    key: str = ""


# From the relay to the origin


class OpenLane(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Send this lane from now on; `ticket` is of somebody who may see it, for a copy."""

    lane: Name
    ticket: TicketText = ""


class CloseLane(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Send this lane no more."""

    lane: Name


class Refresh(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Send the lane's snapshot again: the frames since the last are larger than it."""

    lane: Name


class OpenScene(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Send the 3D view of a document from now on."""

    document: Name
    opening: Number
    """Frames and what is asked for them carry it: those of an opening before are none of this."""
    ticket: TicketText = ""


class CloseScene(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Send the 3D view no more."""

    document: Name


class WantBlobs(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """The relay has none of these (BLAKE2b digests); a frame of the 3D view waits for them."""

    document: Name
    opening: Number
    digests: tuple[bytes, ...]


class Arrive(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A page of a member was opened, or one that asks for something; `page` is its number."""

    page: Number
    ticket: TicketText


class Leave(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A page was closed."""

    page: Number


class Viewers(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """So many pages are open in all, and of people who are not in the class."""

    pages: Count
    guests: Count


class Ask(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A command of a page, as JSON; asked for again at the origin, which answers to the page."""

    page: Number
    number: Number
    text: bytes


class AskJoin(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Somebody filled in the form to join."""

    number: Number
    name: Typed
    code: Typed
    password: Typed
    ticket: TicketText
    """Of before; empty: none."""


class AskTopic(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A command of the data lane, as JSON; subscriptions are numbered by the relay."""

    text: bytes
    ticket: TicketText = ""


class AskDownload(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A document for other programs."""

    number: Number
    ticket: TicketText
    document: Name
    what: Name
    options: tuple[tuple[str, str], ...] = ()


class Ping(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Answered at once with a `Pong` of the same number; a clock of the sender's."""

    sent_ns: Number


class Taken(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """The relay has ended this line, and takes nothing more of it."""

    reason: str
    """Why it is not to be dialled again: another studio came later and proved that the room is its;
    empty: it may be.
    """


# From the origin to the relay


class RoomState(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """What the relay must know of the room; first on the stream, then at each change."""

    session: str
    """Changes when the studio was started anew."""
    tickets: bytes
    """Public key of those who sign tickets."""
    link: bytes
    """Digest of the code in the link, by which a relay knows who has it."""
    is_open: bool
    has_password: bool
    default_document: str
    documents: tuple[str, ...]
    """Shared documents that are open."""
    shown: str
    """The copy that everybody may see; empty: none."""
    holder: str
    """The person who has control; empty: the presenter."""
    controlled: str
    """The document that the holder has control of."""
    others: tuple[str, ...]
    """Addresses of the other relays of this room."""
    sent_out: tuple[str, ...]
    """Persons who may not come in."""


class LaneSnapshot(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """The whole state of a lane; its frames follow, and the stream numbers them all."""

    lane: str
    frames: tuple[Frame, ...]


class LaneFrame(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """What is new on a lane."""

    lane: str
    frame: Frame


class LaneClosed(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """There is no such lane, or none that the ticket may see."""

    lane: str
    reason: str


class SceneFrame(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A frame of viser's, the first of a scene with the whole state.

    `parts`, joined, are the frame; a part of `DIGEST_BYTES` that `is_digest` marks stands for the
    bytes that have this digest.
    """

    document: str
    opening: int
    is_first: bool
    parts: tuple[bytes, ...]
    is_digest: tuple[bool, ...]
    announced: tuple[bytes, ...] = ()
    """Digests whose bytes follow without being asked for."""


class Blob(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """The bytes that have a digest."""

    digest: bytes
    data: bytes


class SceneClosed(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """There is no such scene, or none that the ticket may see."""

    document: str


class Say(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """For one page alone."""

    page: int
    frame: Frame


class Settled(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A command was answered, by what was said to its page before."""

    page: int
    number: int


class Joined(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """Somebody is in the class, by this ticket; or may not, as `NotJoiningError` says."""

    number: int
    ticket: str
    why: str = ""
    reason: str = ""


class EndPerson(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """End all connections of a person."""

    person: str


class TopicState(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A message of the data lane, as JSON."""

    text: bytes


class TopicTick(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """A frame of the data lane (`studio.live.topics.frames`)."""

    frame: bytes
    kept_for: int = -1
    """A subscription: these are latched messages, for it alone; -1: for all."""


class Downloaded(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """What was asked for; or why not: `kind` is the error's class name."""

    number: int
    name: str = ""
    media_type: str = ""
    data: bytes = b""
    kind: str = ""
    reason: str = ""


class Pong(msgspec.Struct, frozen=True, tag=True, array_like=True):
    """The answer to a `Ping`."""

    sent_ns: int


Up: TypeAlias = (
    OpenLane | CloseLane | Refresh | OpenScene | CloseScene | WantBlobs | Arrive | Leave | Viewers
    | Ask | AskJoin | AskTopic | AskDownload | Ping | Taken
)  # fmt: skip
Down: TypeAlias = (
    RoomState | LaneSnapshot | LaneFrame | LaneClosed | SceneFrame | Blob | SceneClosed | Say
    | Settled | Joined | EndPerson | TopicState | TopicTick | Downloaded | Pong
)  # fmt: skip

_ENCODER: Final = msgspec.msgpack.Encoder()
_UP: Final = msgspec.msgpack.Decoder(Up)
_DOWN: Final = msgspec.msgpack.Decoder(Down)


def encode(message: Up | Down) -> bytes:
    """Return a message as it goes into the stream."""
    return _ENCODER.encode(message)


def decode_up(data: bytes) -> Up:
    """Read a message of a relay.

    Raises:
        RelayLineError: It is none.
    """
    return cast("Up", _decoded(_UP, data))


def decode_down(data: bytes) -> Down:
    """Read a message of an origin.

    Raises:
        RelayLineError: It is none.
    """
    return cast("Down", _decoded(_DOWN, data))


def _decoded(
    decoder: msgspec.msgpack.Decoder[Up] | msgspec.msgpack.Decoder[Down], data: bytes
) -> Up | Down:
    try:
        return decoder.decode(data)
    except (msgspec.MsgspecError, UnicodeDecodeError) as error:
        raise RelayLineError(f"what came is none of its messages ({error}).") from None
