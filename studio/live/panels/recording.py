"""Recording the ROS system from pages, and writing parts of what is shown into bags."""

from __future__ import annotations

import asyncio
import shutil
import time
from datetime import datetime
from typing import TYPE_CHECKING, Final, Protocol

from studio.errors import BagError, CommandError
from studio.files import is_folder
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.listeners import send
from studio.protocol.playback import BagOpening
from studio.protocol.recording import (
    BagEntry,
    Bags,
    BagWriting,
    BagWritten,
    CutBag,
    ListBags,
    RecordedCount,
    RecordingState,
    SavePast,
    StartRecording,
    StopRecording,
    StopWriting,
)
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from contextlib import AbstractContextManager
    from pathlib import Path

    from studio.bags.recording import Recording
    from studio.live.connection.link import WireLink
    from studio.live.connection.ros_connection import RosConnection
    from studio.nodes.bag_recorder import BagRecorder
    from studio.protocol.listeners import Listener

FOLDER: Final = "bags"
"""Of the data folder."""
_TELL_EVERY_S: Final = 1.0
_WRITING_EVERY_S: Final = 0.25
_TOPICS_SHOWN: Final = 1_000
_BAGS_SHOWN: Final = 1_000
_FILES_SHOWN: Final = 1_000
"""Of a bag."""
_NS: Final = 1_000_000_000
_WRITES: Final = Limits(per_second=2.0)


class Shown(Protocol):
    """A recording that a document shows, and what the times of its page count from, ns."""

    @property
    def recording(self) -> Recording:
        """Where the messages are."""
        ...

    @property
    def zero_ns(self) -> int:
        """Since the Unix epoch."""
        ...


class _Writing:
    """A part that is being written into a bag, and how far that is."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.done = 0.0
        self.is_stopped = False

    def note(self, share: float) -> None:
        """Note how far it is; called in the thread that writes.

        Raises:
            CommandError: It is to be written no further.
        """
        if self.is_stopped:
            raise CommandError("Writing was stopped: no bag is left of it.")
        self.done = share


class BagRecording:
    """Carries out the commands about recording; used on the event loop only.

    One recording runs at a time, and one part is written. A recording goes on when the page that
    began it is closed, and ends, whole, with the connection or the studio.

    Args:
        wire: The connection whose topics are recorded.
        folder: Where bags are written; it is made with the first.
    """

    def __init__(self, wire: RosConnection, folder: Path) -> None:
        self._wire, self._folder = wire, folder
        self._listeners: set[Listener] = set()
        self._recorder: BagRecorder | None = None
        self._begun_in = folder
        """Where the last recording was begun."""
        self._begun_s = 0.0
        self._last = _nothing_recorded()
        self._telling: asyncio.Task[None] | None = None
        self._writing: _Writing | None = None
        self._turn = asyncio.Lock()
        self.shown: Callable[[str], AbstractContextManager[Shown]] = _nothing_shown
        """Holds the bag that a document shows, by its id; raises a CommandError without one."""
        self.past: Callable[[str], AbstractContextManager[Shown]] = _nothing_shown
        """Holds the last minutes of the system that a document shows; raises likewise."""

    @property
    def folder(self) -> Path:
        """Where bags are written."""
        return self._folder

    def is_writing(self, folder: Path) -> bool:
        """Whether a bag is recorded or written into a folder now."""
        writing = None if self._writing is None else self._writing.folder
        return folder in {writing, None if self._recorder is None else self._begun_in}

    def attach(self, listener: Listener) -> None:
        """Send a page the state, now and whenever it changes."""
        self._listeners.add(listener)
        self._send_to(listener)
        if self._writing is not None:
            send(listener, BagWriting(done=self._writing.done))

    def detach(self, listener: Listener) -> None:
        """Forget a page; what it began goes on."""
        self._listeners.discard(listener)

    async def start(self, command: StartRecording) -> None:
        """Begin to record.

        Raises:
            CommandError: Something is recorded already, or there is no connection.
            StudioError: The bag cannot be begun; the sentence says why.
        """
        async with self._turn:
            if self._recorder is not None:
                raise CommandError("A recording is under way: stop it first.")
            link = self._wire.current
            if link is None:
                raise CommandError("There is no connection with a ROS system: connect first.")
            path = self._begun_in = self._new_path(command.name)
            loop = asyncio.get_running_loop()

            def ended() -> None:
                loop.call_soon_threadsafe(self._ended)

            self._recorder = await asyncio.to_thread(_begin, link, path, command, ended)
            self._begun_s = time.monotonic()
            self._telling = asyncio.create_task(self._keep_telling())
        self._tell()

    async def stop(self) -> None:
        """End the recording; its bag is whole then. Without one, nothing is done."""
        async with self._turn:
            recorder, telling = self._recorder, self._telling
            if recorder is None:
                return
            if telling is not None:
                telling.cancel()
            await asyncio.to_thread(recorder.close)
            self._last = await asyncio.to_thread(self._state, recorder, is_recording=False)
            self._recorder = None
        self._tell()

    async def save_past(self, command: SavePast) -> BagWritten:
        """Write the last seconds of the live system.

        Raises:
            CommandError: Nothing is kept of it.
            StudioError: The bag cannot be written.
        """
        with self.past(command.document) as shown:
            end_ns = shown.recording.end_ns + 1
            begin_ns = max(shown.recording.begin_ns, end_ns - int(command.seconds * _NS))
            return await self._written(command.request, command.name, shown, (begin_ns, end_ns), ())

    async def cut(self, command: CutBag) -> BagWritten:
        """Write a part of what a document shows.

        Raises:
            CommandError: It shows no recording.
            StudioError: The part is empty, or the bag cannot be written.
        """
        with self.shown(command.document) as shown:
            span = tuple(
                shown.zero_ns + round(one * _NS) for one in (command.begin_s, command.end_s)
            )
            # The end is part of it: a page sends the time of the last message.
            part = span[0], span[1] + 1
            return await self._written(command.request, command.name, shown, part, command.topics)

    async def list(self, command: ListBags) -> Bags:
        """Return the bags of the folder, the newest first."""
        bags = await asyncio.to_thread(_bags_in, self._folder)
        return Bags(request=command.request, folder=str(self._folder), bags=tuple(bags))

    def stop_writing(self) -> None:
        """Write a part no further; who asked for it is told. Without one, nothing is done."""
        if self._writing is not None:
            self._writing.is_stopped = True

    async def close(self) -> None:
        """End the recording, and write no part any further."""
        self.stop_writing()
        await self.stop()

    async def _written(
        self,
        request: int,
        name: str,
        shown: Shown,
        span_ns: tuple[int, int],
        topics: Sequence[str],
    ) -> BagWritten:
        from studio.bags.cutting import write_recording  # noqa: PLC0415 - imports mcap

        if self._writing is not None:
            raise CommandError("A part is being written already: wait for it, or stop it.")
        path = self._new_path(name)
        writing = self._writing = _Writing(path)
        telling = asyncio.create_task(self._keep_telling_of(writing))
        try:
            written = await asyncio.to_thread(
                write_recording, shown.recording, path, topics, *span_ns, writing.note
            )
        finally:
            telling.cancel()
            self._writing = None
            self._tell_all(BagWriting(done=None))
        return BagWritten(
            request=request, path=str(written.path), messages=written.messages, bytes=written.bytes
        )

    def _new_path(self, name: str) -> Path:
        """Return the path of a new bag.

        Raises:
            CommandError: The name leads elsewhere.
        """
        name = name.strip() or datetime.now().strftime("rosbag2_%Y_%m_%d-%H_%M_%S")  # noqa: DTZ005 - as on the clock of the owner
        if name.startswith(".") or not all(one.isprintable() and one not in "/\\:" for one in name):
            raise CommandError(
                f'"{name[:80]}" is no name of a bag: give letters, digits, dashes and dots.'
            )
        return self._folder / name

    def _ended(self) -> None:
        """The bag could not be written any further."""
        self._ending = asyncio.create_task(self.stop())

    async def _keep_telling(self) -> None:
        while (recorder := self._recorder) is not None:
            self._last = await asyncio.to_thread(self._state, recorder, is_recording=True)
            self._tell()
            await asyncio.sleep(_TELL_EVERY_S)

    async def _keep_telling_of(self, writing: _Writing) -> None:
        while True:
            self._tell_all(BagWriting(done=writing.done))
            await asyncio.sleep(_WRITING_EVERY_S)

    def note_opening(self, name: str, done: float | None) -> None:
        """Send those who open bags how far one is read, 0 to 1; None: that has ended."""
        for listener in tuple(self._listeners):
            if listener.role is Role.PRESENTER:
                send(listener, BagOpening(name=name, done=done))

    def _tell_all(self, event: BagWriting) -> None:
        for listener in tuple(self._listeners):
            send(listener, event)

    def _tell(self) -> None:
        for listener in tuple(self._listeners):
            self._send_to(listener)

    def _send_to(self, listener: Listener) -> None:
        """Send the state; where bags lie on the disk is the owner's affair."""
        is_owner = listener.role is Role.PRESENTER
        send(listener, self._last if is_owner else self._last.model_copy(update={"path": ""}))

    def _state(self, recorder: BagRecorder, *, is_recording: bool) -> RecordingState:
        counts = recorder.counts()
        return RecordingState(
            recording=is_recording,
            path=str(recorder.path),
            seconds=time.monotonic() - self._begun_s,
            messages=sum(one.count for one in counts),
            lost=sum(one.lost for one in counts),
            bytes=recorder.size,
            free_bytes=_free_bytes(recorder.path),
            topics=tuple(
                RecordedCount(
                    name=one.name, type_name=one.type_name, count=one.count, lost=one.lost
                )
                for one in counts[:_TOPICS_SHOWN]
            ),
            trouble=recorder.trouble,
        )


def _free_bytes(path: Path) -> int:
    """Return the room beside a bag; 0 where its folder was taken away meanwhile."""
    try:
        return shutil.disk_usage(path).free
    except OSError:
        return 0


def _begin(
    link: WireLink, path: Path, command: StartRecording, ended: Callable[[], object]
) -> BagRecorder:
    from studio.bags.mcap_writer import Chunking  # noqa: PLC0415 - imports mcap
    from studio.bags.writer import Storing  # noqa: PLC0415 - imports mcap
    from studio.nodes.bag_recorder import BagRecorder, RecordSettings  # noqa: PLC0415 - imports mcap
    from studio.nodes.recorded_topics import TopicChoice  # noqa: PLC0415 - imports ros

    is_zstd, compression = command.compression == "zstd", command.compression
    in_chunks = command.storage == "mcap" and compression != "none"
    if command.storage == "sqlite3" and compression == "lz4":
        raise CommandError("Bags of sqlite3 are compressed by zstd alone: choose that, or mcap.")
    storing = Storing(
        storage=command.storage,
        chunking=Chunking(compression=compression if in_chunks and compression != "none" else ""),
        mode="message" if is_zstd and command.storage == "sqlite3" else "none",
        max_bytes=command.max_bag_bytes,
        max_s=command.max_bag_s,
    )
    choice = TopicChoice(
        all=not (command.topics or command.regex),
        topics=frozenset(command.topics),
        regex=command.regex,
        exclude_regex=command.exclude_regex,
    )
    settings = RecordSettings(topics=choice, storing=storing)
    return BagRecorder(link.node, path, settings, _untold, ended)


def _bags_in(folder: Path) -> list[BagEntry]:
    from studio.bags.metadata import METADATA_NAME, read_metadata  # noqa: PLC0415 - takes its time

    found: list[BagEntry] = []
    for path in folder.iterdir() if is_folder(folder) else ():
        try:
            about = read_metadata(path / METADATA_NAME)
            files = sorted(one for one in path.iterdir() if one.is_file())[:_FILES_SHOWN]
            size = sum(one.stat().st_size for one in files)
        except (BagError, OSError):  # no bag, or one that just goes
            continue
        found.append(
            BagEntry(
                path=str(path),
                name=path.name,
                begin_s=about.begin_ns / _NS if about.count else 0.0,
                seconds=about.duration_ns / _NS,
                bytes=size,
                messages=about.count,
                files=tuple(one.name for one in files),
            )
        )
    return sorted(found, key=lambda one: (one.begin_s, one.name), reverse=True)[:_BAGS_SHOWN]


def _nothing_recorded() -> RecordingState:
    return RecordingState(
        recording=False,
        path="",
        seconds=0.0,
        messages=0,
        lost=0,
        bytes=0,
        free_bytes=0,
        topics=(),
        trouble="",
    )


def _nothing_shown(_document: str) -> AbstractContextManager[Shown]:
    raise CommandError("The document shows no recording: open a bag, or connect with a robot.")


def _untold(_told: object) -> None:
    return


COMMANDS: Final = Commands[BagRecording](Scope.ROS)
COMMANDS.presenter(StartRecording, lambda one, c, _: one.start(c), limits=_WRITES)
COMMANDS.presenter(StopRecording, lambda one, _c, _: one.stop())
COMMANDS.presenter(SavePast, lambda one, c, _: one.save_past(c), limits=_WRITES)
COMMANDS.presenter(CutBag, lambda one, c, _: one.cut(c), limits=_WRITES)
COMMANDS.presenter(StopWriting, lambda one, _c, _: one.stop_writing())
COMMANDS.presenter(ListBags, lambda one, c, _: one.list(c))
