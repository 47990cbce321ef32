"""Recording topics into a bag, saving the last minutes, and cutting a part out of a bag."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from studio.protocol.displays import RosName
from studio.protocol.message import Command, Event, Message
from studio.protocol.playback import AtS


class StartRecording(Command):
    """Record topics into a bag, by the words of `ros2 bag record`; without any, all of them."""

    type: Literal["start_recording"] = "start_recording"
    topics: Annotated[tuple[RosName, ...], Field(max_length=1_000)] = ()
    regex: Annotated[str, Field(max_length=1_000)] = ""
    exclude_regex: Annotated[str, Field(max_length=1_000)] = ""
    name: Annotated[str, Field(max_length=200)] = ""
    """Of the bag's folder; empty: as ros2 names it, by date and time."""
    storage: Literal["mcap", "sqlite3"] = "mcap"
    compression: Literal["none", "zstd", "lz4"] = "none"
    max_bag_bytes: Annotated[int, Field(ge=0)] = 0
    """Another file begins after so many; 0: never."""
    max_bag_s: Annotated[int, Field(ge=0)] = 0


class StopRecording(Command):
    """End the recording; its bag is whole afterwards."""

    type: Literal["stop_recording"] = "stop_recording"


class SavePast(Command):
    """Write the last seconds that are kept of the live system into a bag."""

    type: Literal["save_past"] = "save_past"
    seconds: Annotated[float, Field(gt=0, le=3600)]
    name: Annotated[str, Field(max_length=200)] = ""


class CutBag(Command):
    """Write a part of what is shown into a bag; times are those of `time_state`."""

    type: Literal["cut_bag"] = "cut_bag"
    begin_s: AtS
    end_s: AtS
    topics: Annotated[tuple[RosName, ...], Field(max_length=1_000)] = ()
    """Empty: all."""
    name: Annotated[str, Field(max_length=200)] = ""


class StopWriting(Command):
    """Write no further what `save_past` or `cut_bag` asked for; no bag is left of it."""

    type: Literal["stop_writing"] = "stop_writing"


class BagWriting(Event):
    """How far that is; sent when it begins, a few times in a second, and when it ends."""

    type: Literal["bag_writing"] = "bag_writing"
    done: float | None
    """The share that is written, 0 to 1; None: nothing is being written."""


class BagWritten(Event):
    """Answer to `save_past` and `cut_bag`."""

    type: Literal["bag_written"] = "bag_written"
    request: int
    path: str
    messages: int
    bytes: int


class RecordedCount(Message):
    """What was recorded of a topic."""

    name: str
    type_name: str
    count: int
    lost: int
    """Messages that were sent and are not in the bag."""


class RecordingState(Event):
    """The recording of the live system; sent when it changes, and each second while it runs."""

    type: Literal["recording_state"] = "recording_state"
    recording: bool
    path: str
    """Of the bag that is being written, or of the last one; empty: there was none."""
    seconds: float
    messages: int
    lost: int
    bytes: int
    free_bytes: int
    """Left on the disk."""
    topics: tuple[RecordedCount, ...]
    trouble: str
    """Why it ended by itself, in a sentence; else empty."""


class ListBags(Command):
    """Ask for the bags that can be opened: those of the folder in which the studio records."""

    type: Literal["list_bags"] = "list_bags"


class BagEntry(Message):
    """One of them."""

    path: str
    name: str
    begin_s: float
    """Since the Unix epoch."""
    seconds: float
    bytes: int
    messages: int
    files: tuple[str, ...]
    """Names, each to be had at `/api/bags/{name}/{file}`."""


class Bags(Event):
    """Answer to `list_bags`, the newest first."""

    type: Literal["bags"] = "bags"
    request: int
    folder: str
    bags: tuple[BagEntry, ...]
