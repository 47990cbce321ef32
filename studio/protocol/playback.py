"""The time that a document shows: now, the last minutes, or a moment of a bag.

All times are seconds from `zero_s` of the last `time_state`, which stays as long as the recording
is the same: so small numbers keep their nanoseconds on the way.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field

from studio.protocol.displays import RosName
from studio.protocol.message import Command, Event, Message

RATE_MIN, RATE_MAX = 0.1, 10.0
BINS_MAX = 4_000
BOOKMARKS_MAX = 200
FAR_S = 1e9
"""No recording is so long: thirty years."""


def _near(at_s: float) -> float:
    return max(-FAR_S, min(FAR_S, at_s))


AtS = Annotated[float, AfterValidator(_near)]
"""A time of a page, seconds since the beginning; what is beyond every recording is `FAR_S`."""


class OpenBag(Command):
    """Show a bag in a document; without a document, as one of its own: answered by `opened`."""

    type: Literal["open_bag"] = "open_bag"
    path: str


class BagOpening(Event):
    """How far a damaged or unfinished bag is read that becomes a document of its own."""

    type: Literal["bag_opening"] = "bag_opening"
    name: str
    done: float | None
    """The share that is read, 0 to 1; None: that has ended."""


class GoLive(Command):
    """Show what comes now; a bag is closed."""

    type: Literal["go_live"] = "go_live"


class SeekTime(Command):
    """Show another moment; of a live document, one of the last minutes.

    While a bar is dragged, `settled` is false: what takes longer is left for the last one.
    """

    type: Literal["seek_time"] = "seek_time"
    at_s: AtS
    settled: bool = True


class PlayTime(Command):
    """Let the time go on from where it is, or stop it."""

    type: Literal["play_time"] = "play_time"
    playing: bool


class SetTimeRate(Command):
    """Let the time go faster or slower."""

    type: Literal["set_time_rate"] = "set_time_rate"
    rate: Annotated[float, Field(ge=RATE_MIN, le=RATE_MAX)]


class StepTime(Command):
    """Go to the next message of a topic, or to the one before; an empty topic means any."""

    type: Literal["step_time"] = "step_time"
    topic: RosName = ""
    forward: bool = True


class LoopTime(Command):
    """Play one part again and again; both None: the whole, once."""

    type: Literal["loop_time"] = "loop_time"
    begin_s: AtS | None = None
    end_s: AtS | None = None


class RecordedTopicView(Message):
    """A topic of what is shown."""

    name: str
    type_name: str
    count: int
    latched: bool
    trouble: str
    """Why its messages cannot be read, in a sentence; else empty."""
    note: str
    """What is left out of it, in a sentence; else empty."""


class TimeState(Event):
    """What a document shows, and where it stands; sent whenever that is another.

    While it plays that is once in a second: a page counts on by itself.
    """

    type: Literal["time_state"] = "time_state"
    mode: Literal["live", "past", "bag"]
    """`past`: a moment of the last minutes, while the robot goes on."""
    title: str
    """The name of the bag; else empty."""
    path: str
    zero_s: float
    """What the other times count from, since the Unix epoch."""
    begin_s: float
    end_s: float
    now_s: float
    playing: bool
    rate: float
    loop: tuple[float, float] | None
    skipping: bool
    """Whether messages are left out, for they cannot be read as fast as it is played."""
    queue: int
    """How many wait before this one, for too many rewind at once; 0: it is shown."""
    progress: float | None
    """Of reading a damaged or unfinished file, 0 to 1; None: that is not under way."""
    troubles: tuple[str, ...]
    """What of it cannot be shown, a sentence each."""
    kept_bytes: int
    kept_bytes_max: int
    """Of the last minutes in memory; 0 for a bag."""


class TimeTopics(Event):
    """The topics of what is shown; sent after a `time_state` of another recording."""

    type: Literal["time_topics"] = "time_topics"
    topics: tuple[RecordedTopicView, ...]


class GetTimeMarks(Command):
    """Ask where a topic has messages; an empty one means all together."""

    type: Literal["get_time_marks"] = "get_time_marks"
    topic: RosName = ""
    begin_s: AtS
    end_s: AtS
    bins: Annotated[int, Field(ge=1, le=BINS_MAX)]


class TimeMarks(Event):
    """Answer to `get_time_marks`: how many messages lie in each part; a gap has none."""

    type: Literal["time_marks"] = "time_marks"
    request: int
    counts: tuple[int, ...]


class GetTimeTicks(Command):
    """Ask for errors and warnings of `/rosout` and `/diagnostics` in what is shown."""

    type: Literal["get_time_ticks"] = "get_time_ticks"


class TimeTick(Message):
    """One of them."""

    at_s: float
    level: Literal["warn", "error"]
    source: str
    """Name of the node, or of the part."""
    text: str


class TimeTicks(Event):
    """Answer to `get_time_ticks`; `more` were left out, and `done` is the share that was read."""

    type: Literal["time_ticks"] = "time_ticks"
    request: int
    ticks: tuple[TimeTick, ...]
    more: int
    done: float


class Bookmark(Message):
    """A moment with a name."""

    at_s: Annotated[float, Field(ge=-FAR_S, le=FAR_S)]
    name: Annotated[str, Field(max_length=200)]


class Bookmarks(Event):
    """The bookmarks of what is shown, by time; they are kept beside a bag's files."""

    type: Literal["bookmarks"] = "bookmarks"
    bookmarks: tuple[Bookmark, ...]
    trouble: str
    """Why they cannot be kept, in a sentence; else empty."""


class SetBookmarks(Command):
    """Keep these bookmarks, and no others."""

    type: Literal["set_bookmarks"] = "set_bookmarks"
    bookmarks: Annotated[tuple[Bookmark, ...], Field(max_length=BOOKMARKS_MAX)]


class GetSeries(Command):
    """Ask for a number of a topic's messages over a range, as few values as a picture can show."""

    type: Literal["get_series"] = "get_series"
    topic: RosName
    path: Annotated[str, Field(max_length=500)]
    """Of the number in a message, as `pose.position.x` or `ranges[3]`."""
    begin_s: AtS
    end_s: AtS
    columns: Annotated[int, Field(ge=1, le=BINS_MAX)]


class Series(Event):
    """Answer to `get_series`: the least and the largest value of each column, in their order.

    A column without a message has None for both. What is not finite is left out.
    """

    type: Literal["series"] = "series"
    request: int
    first: tuple[float | None, ...]
    second: tuple[float | None, ...]
    before: tuple[float, float] | None
    """The last one before the range, its time and value; None: there is none near."""
    after: tuple[float, float] | None
    """The first one after it."""
    exact: bool
    """Whether every message was read; else only some were, and it is to be asked again."""
    done: float
    """The share that was read, 0 to 1."""
    count: int
    """Numbers that were read, of the whole recording."""
    trouble: str
    """Why there is no such number, in a sentence; else empty."""
