"""DocumentTime: whether a document shows what runs now, or which moment of a recording."""

from __future__ import annotations

import asyncio
import re
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.errors import CommandError, StudioError
from studio.live.time.recording_source import RecordingSource
from studio.live.time.series import COMMANDS as SERIES_COMMANDS
from studio.live.time.series import SeriesReader
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.listeners import LastSent
from studio.protocol.playback import (
    GetTimeMarks,
    GoLive,
    LoopTime,
    PlayTime,
    RecordedTopicView,
    SeekTime,
    SetTimeRate,
    StepTime,
    TimeMarks,
    TimeState,
    TimeTopics,
)

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterable

    from numpy.typing import NDArray

    from studio.bags.recording import Recording
    from studio.live.time.document_source import DocumentSource
    from studio.live.time.playhead import Playhead
    from studio.live.time.shown import ShownRecording
    from studio.protocol import Event
    from studio.protocol.listeners import Audience

_S: Final = 1_000_000_000
_TELL_EVERY_S: Final = 1.0
_TOPICS_MAX: Final = 10_000
_TROUBLES_MAX: Final = 50
_SENTENCE_MAX: Final = 500
_LIVE: Final = "The document shows what runs now: open a bag, or drag the time back."


class DocumentTime:
    """Carries out the commands about a document's time; used on the event loop only.

    Args:
        source: The topics of the document.
        audience: Is sent where it stands.

    Attributes:
        series: Answers with numbers over what is shown.
    """

    def __init__(self, source: DocumentSource, audience: Audience) -> None:
        self._source, self._audience = source, audience
        self.series = SeriesReader(self)
        self._shown: ShownRecording | None = None
        self._playing: RecordingSource | None = None
        self._zero_ns = 0
        self._progress: float | None = None
        self._trouble = ""
        self._sent = LastSent[TimeState](audience)
        self._turn = asyncio.Lock()
        """Held while another time is taken up."""
        self._stepping = asyncio.Lock()
        self._telling: asyncio.Task[None] | None = None
        self._closed = False
        self.past: Callable[[], ShownRecording | None] = lambda: None
        """Gives what is kept of the last minutes, held once more; None: nothing is."""
        self.on_switch: Callable[[], Awaitable[None]] = _nothing
        """Called once topics come from elsewhere."""
        self.on_moment: Callable[[], Awaitable[None]] = _nothing
        """Called once all have been given another moment: it is drawn at once."""

    @property
    def recording(self) -> Recording | None:
        """What is shown; None: what runs now."""
        return None if self._shown is None else self._shown.recording

    @property
    def shown(self) -> ShownRecording | None:
        """The same, with its name and its files."""
        return self._shown

    @property
    def path(self) -> str:
        """Where the files of the bag are; empty: no bag is shown."""
        return "" if self._shown is None else self._shown.path

    @property
    def zero_ns(self) -> int:
        """What the times of pages count from, since the Unix epoch."""
        return self._zero_ns

    @property
    def at_ns(self) -> int:
        """The moment that is shown."""
        return self._source.now_ns

    def events(self) -> Iterable[Event]:
        """Yield the events for a new page."""
        yield self._state()
        if self._shown is not None:
            yield _topics_event(self._shown.recording)

    def ns_of(self, at_s: float) -> int:
        """Return a time of pages as ns since the Unix epoch."""
        return self._zero_ns + round(at_s * _S)

    def note_progress(self, share: float | None) -> None:
        """Send how far the reading of a damaged or unfinished file is, 0 to 1; None: it ended."""
        self._progress = share
        self._send()

    # What is shown

    async def show(self, shown: ShownRecording | None, at_ns: int | None = None) -> None:
        """Show a recording, which is let go with the next one; None: show what runs now.

        Args:
            shown: The recording.
            at_ns: Where it stands at first; None: at its beginning.
        """
        async with self._turn:
            if shown is None and self._shown is None:
                return
            before, self._shown = self._shown, shown
            source, self._playing = self._playing, None
            self._trouble = ""
            if shown is not None:
                self._begin(shown, at_ns)
            await asyncio.to_thread(self._source.show, self._playing)
            await asyncio.to_thread(_end, source, before)
            await self._tell_switch()
        if self._closed:
            await self.close()

    async def go_live(self) -> None:
        """Show what runs now."""
        await self.show(None)

    async def close(self) -> None:
        """Show nothing of a recording any more."""
        self._closed = True
        if self._telling is not None:
            self._telling.cancel()
        source, self._playing = self._playing, None
        shown, self._shown = self._shown, None
        if source is not None:
            await asyncio.to_thread(self._source.show, None)
        await asyncio.to_thread(_end, source, shown)

    def _begin(self, shown: ShownRecording, at_ns: int | None) -> None:
        recording = shown.recording
        self._zero_ns = recording.begin_ns
        node = f"/{_node_name(shown.title)}"
        made = RecordingSource(recording, node, at_ns, self._source.settling)
        loop = asyncio.get_running_loop()

        def stopped(why: str) -> None:  # in the thread of the source
            if not loop.is_closed():
                loop.call_soon_threadsafe(self._note_stop, made, why)

        made.on_stop = stopped
        self._playing = made

    async def _tell_switch(self) -> None:
        self._send()
        if self._shown is not None:
            self._audience.send(_topics_event(self._shown.recording))
        await self.on_switch()

    # Where it stands

    async def seek(self, command: SeekTime) -> None:
        """Show another moment; answered when it is drawn.

        Raises:
            StudioError: There is none, or it cannot be read.
        """
        if self._playing is None:
            await self._go_back()
        await self._jump(self.ns_of(command.at_s), settled=command.settled)

    async def _go_back(self) -> None:
        """Show the last minutes of the live system."""
        past = self.past()
        if past is None:
            raise CommandError(_LIVE)
        await self.show(past, past.recording.end_ns)

    async def step(self, command: StepTime) -> None:
        """Go to the next message of a topic, or the one before; without one it stays."""
        async with self._stepping:
            source = self._demand()
            self._change(lambda head: replace(head, playing=False))
            find = partial(_neighbour, source.recording, command, source.playhead.at_ns)
            at_ns = await asyncio.to_thread(find)
            if at_ns is not None:
                await self._jump(at_ns, settled=True)

    def play(self, command: PlayTime) -> None:
        """Let the time go on, or stop it."""
        recording = self._demand().recording
        begin_ns, end_ns = recording.begin_ns, recording.end_ns
        if command.playing:
            self._change(lambda head: head.started(begin_ns, end_ns))
        else:
            self._change(lambda head: replace(head, playing=False))

    def set_rate(self, command: SetTimeRate) -> None:
        """Let the time go faster or slower."""
        self._change(lambda head: replace(head, rate=command.rate))

    def loop(self, command: LoopTime) -> None:
        """Play one part again and again, or the whole once."""
        if command.begin_s is None and command.end_s is None:
            self._change(lambda head: replace(head, loop=None))
            return
        recording = self._demand().recording
        begin_ns = recording.begin_ns if command.begin_s is None else self.ns_of(command.begin_s)
        end_ns = recording.end_ns if command.end_s is None else self.ns_of(command.end_s)
        begin_ns, end_ns = max(recording.begin_ns, begin_ns), min(recording.end_ns, end_ns)
        if begin_ns >= end_ns:
            raise CommandError("A loop ends after it begins, within the recording.")
        self._change(lambda head: replace(head, loop=(begin_ns, end_ns)))

    async def marks(self, command: GetTimeMarks) -> TimeMarks:
        """Return how many messages of a topic lie in each part of a range."""
        recording = self._demand().recording
        range_ns = self.ns_of(command.begin_s), self.ns_of(command.end_s)
        counts = await asyncio.to_thread(_counts, recording, command.topic, range_ns, command.bins)
        return TimeMarks(request=command.request, counts=tuple(counts.tolist()))

    def _demand(self) -> RecordingSource:
        """Return the source of what is shown.

        Raises:
            CommandError: It is what runs now.
        """
        if self._playing is None:
            raise CommandError(_LIVE)
        return self._playing

    def _change(self, change: Callable[[Playhead], Playhead]) -> None:
        self._demand().change(change)
        self._trouble = ""
        self._send()
        if self._telling is None or self._telling.done():
            self._telling = asyncio.create_task(self._keep_telling())

    async def _jump(self, at_ns: int, *, settled: bool) -> None:
        loop, source = asyncio.get_running_loop(), self._demand()
        done: asyncio.Future[StudioError | None] = loop.create_future()

        def jumped(trouble: StudioError | None) -> None:  # in the thread of the source
            if not loop.is_closed():
                loop.call_soon_threadsafe(_settle, done, trouble)

        source.jump(at_ns, jumped, settled=settled)
        if (trouble := await done) is not None:
            raise trouble
        if source is self._playing:
            await self.on_moment()
            self._send()

    async def _keep_telling(self) -> None:
        while self._playing is not None and self._playing.playhead.playing:
            await asyncio.sleep(_TELL_EVERY_S)
            self._send()

    def _note_stop(self, source: RecordingSource, why: str) -> None:
        if source is self._playing:
            self._trouble = why
            self._send()

    def _send(self) -> None:
        self._sent.send(self._state())

    def _state(self) -> TimeState:
        shown, source = self._shown, self._playing
        if shown is None or source is None:
            return _live_state(self._progress)
        recording, head = shown.recording, source.playhead
        loop = head.loop and (self._s_of(head.loop[0]), self._s_of(head.loop[1]))
        troubles = (self._trouble, *recording.troubles[:_TROUBLES_MAX])
        return TimeState(
            mode=shown.mode,
            title=shown.title,
            path=shown.path,
            zero_s=self._zero_ns / _S,
            begin_s=self._s_of(recording.begin_ns),
            end_s=self._s_of(recording.end_ns),
            now_s=self._s_of(head.at_ns),
            playing=head.playing,
            rate=head.rate,
            loop=loop,
            queue=0,
            progress=self._progress,
            troubles=tuple(one[:_SENTENCE_MAX] for one in troubles if one),
            kept_bytes=0,
            kept_bytes_max=0,
        )

    def _s_of(self, at_ns: int) -> float:
        return (at_ns - self._zero_ns) / _S


async def _nothing() -> None:
    return


def _end(source: RecordingSource | None, shown: ShownRecording | None) -> None:
    if source is not None:
        source.close()
    if shown is not None:
        shown.let_go()


def _settle(done: asyncio.Future[StudioError | None], trouble: StudioError | None) -> None:
    if not done.done():
        done.set_result(trouble)


def _node_name(title: str) -> str:
    """Return a name of a node for a bag: ROS's have letters, digits and `_`."""
    name = re.sub(r"\W+", "_", title, flags=re.ASCII).strip("_") or "bag"
    return f"bag_{name}" if name[0].isdigit() else name


def _neighbour(recording: Recording, command: StepTime, at_ns: int) -> int | None:
    names = [command.topic] if command.topic else [one.name for one in recording.topics]
    names = [one for one in names if any(one == each.name for each in recording.topics)]
    if command.forward:
        found = (recording.next_ns(one, at_ns) for one in names)
        return min((one for one in found if one is not None), default=None)
    found = (recording.previous_ns(one, at_ns) for one in names)
    return max((one for one in found if one is not None), default=None)


def _counts(
    recording: Recording, topic: str, range_ns: tuple[int, int], bins: int
) -> NDArray[np.int64]:
    counts = np.zeros(bins, np.int64)
    if range_ns[0] < range_ns[1]:
        for one in recording.topics:
            if topic in {"", one.name}:
                counts += recording.counts(one.name, *range_ns, bins)
    return counts


def _topics_event(recording: Recording) -> TimeTopics:
    return TimeTopics(
        topics=tuple(
            RecordedTopicView(
                name=one.name,
                type_name=one.type_name,
                count=one.count,
                latched=one.is_latched,
                trouble=one.trouble,
                note=one.note,
            )
            for one in recording.topics[:_TOPICS_MAX]
        )
    )


def _live_state(progress: float | None) -> TimeState:
    return TimeState(
        mode="live",
        title="",
        path="",
        zero_s=0.0,
        begin_s=0.0,
        end_s=0.0,
        now_s=0.0,
        playing=False,
        rate=1.0,
        loop=None,
        queue=0,
        progress=progress,
        troubles=(),
        kept_bytes=0,
        kept_bytes_max=0,
    )


_SEEKS: Final = Limits(per_second=120)
_MARKS: Final = Limits(per_second=60)

COMMANDS: Final = Commands[DocumentTime](Scope.DOCUMENT)
COMMANDS.controller(GoLive, lambda time, _, __: time.go_live())
COMMANDS.controller(SeekTime, lambda time, c, _: time.seek(c), limits=_SEEKS)
COMMANDS.controller(PlayTime, lambda time, c, _: time.play(c))
COMMANDS.controller(SetTimeRate, lambda time, c, _: time.set_rate(c))
COMMANDS.controller(StepTime, lambda time, c, _: time.step(c), limits=_SEEKS)
COMMANDS.controller(LoopTime, lambda time, c, _: time.loop(c))
COMMANDS.viewer(GetTimeMarks, lambda time, c, _: time.marks(c), limits=_MARKS)
COMMANDS.include(SERIES_COMMANDS, lambda time, _: time.series)
