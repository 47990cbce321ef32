"""DocumentTime: whether a document shows what runs now, or which moment of a recording."""

from __future__ import annotations

import asyncio
import re
import time
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.errors import CommandError, StudioError
from studio.live.time.bookmarks import COMMANDS as BOOKMARK_COMMANDS
from studio.live.time.bookmarks import Bookmarks
from studio.live.time.playhead import Playhead
from studio.live.time.recording_source import RecordingSource
from studio.live.time.series import COMMANDS as SERIES_COMMANDS
from studio.live.time.series import SeriesReader
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.listeners import LastSent
from studio.protocol.playback import (
    GetTimeMarks,
    GetTimeTicks,
    GoLive,
    LoopTime,
    PlayTime,
    RecordedTopicView,
    SeekTime,
    SetTimeRate,
    StepTime,
    TimeMarks,
    TimeState,
    TimeTick,
    TimeTicks,
    TimeTopics,
)

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Coroutine, Generator, Iterable, Sequence

    from numpy.typing import NDArray

    from studio.bags.recording import RecordedTopic, Recording
    from studio.live.time.bookmarks import BookmarkFile
    from studio.live.time.document_source import DocumentSource
    from studio.live.time.rewinding import Rewinding, Seat
    from studio.live.time.shown import ShownRecording
    from studio.live.time.ticks import Tick
    from studio.protocol import Event
    from studio.protocol.listeners import Audience

_S: Final = 1_000_000_000
_TELL_EVERY_S: Final = 1.0
_TOPICS_EVERY_S: Final = 5.0
"""Their counts grow with all that comes."""
_LEFT_S: Final = 60.0
"""After so long without a page the last minutes are left to those who wait for a place."""
_TOPICS_MAX: Final = 10_000
_TROUBLES_MAX: Final = 50
_SENTENCE_MAX: Final = 500
_TOPICS_OFTEN: Final = 200
"""So many are sent again and again."""
_AT_LIVE: Final = Playhead(0)
_LIVE: Final = "The document shows what runs now: open a bag, or drag the time back."


class DocumentTime:
    """Carries out the commands about a document's time; used on the event loop only.

    Args:
        source: The topics of the document.
        audience: Is sent where it stands.
        rewinding: The last minutes of the live system.
        bookmark_file: Gives the file of bookmarks for the bag at a path; in a thread.
        writes: Whether that is written.

    Attributes:
        series: Answers with numbers over what is shown.
        bookmarks: Moments of it with names.
    """

    def __init__(
        self,
        source: DocumentSource,
        audience: Audience,
        rewinding: Rewinding,
        bookmark_file: Callable[[str], BookmarkFile],
        *,
        writes: bool,
    ) -> None:
        self._source, self._audience, self._rewinding = source, audience, rewinding
        self.bookmarks = Bookmarks(self, audience, bookmark_file, writes=writes)
        self.series = SeriesReader(self)
        self._shown: ShownRecording | None = None
        self._playing: RecordingSource | None = None
        self._seat: Seat | None = None
        """Waited for; with the last minutes that are shown goes the place."""
        self._seat_at_ns = 0
        self._tasks: set[asyncio.Task[None]] = set()
        self._left_s: float | None = None
        """Since when no page looks."""
        self._told_topics: tuple[float, tuple[tuple[str, str], ...]] = 0.0, ()
        self._progress: float | None = None
        self._trouble = ""
        self._sent = LastSent[TimeState](audience)
        self._turn = asyncio.Lock()
        """Held while another time is taken up."""
        self._stepping = asyncio.Lock()
        self._counting = asyncio.Lock()
        """Held while marks are counted: many who ask leave threads to others."""
        self._telling: asyncio.Task[None] | None = None
        self._closed = False
        self.others: Callable[[], ShownRecording | None] = lambda: None
        """Returns the bag that a copy rewinds instead of the last minutes: that of its class."""
        self.on_switch: Callable[[], Awaitable[None]] = _nothing
        """Called once topics come from elsewhere."""
        self.on_moment: Callable[[], Awaitable[None]] = _nothing
        """Called once all have been given another moment: it is drawn at once."""
        rewinding.follow(self.refresh)

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
        """Where the files of the bag are that the timeline is about; empty: it is of none."""
        shown = self._shown or self.others()
        return "" if shown is None else shown.path

    @property
    def zero_ns(self) -> int:
        """What the times of pages count from, since the Unix epoch."""
        shown = self._shown or self.others()
        return self._rewinding.facts.zero_ns if shown is None else shown.zero_ns

    @property
    def at_ns(self) -> int:
        """The moment that is shown."""
        return self._source.now_ns

    def events(self) -> Iterable[Event]:
        """Yield the events for a new page."""
        yield self._state()
        yield _topics_event(self._topics())
        yield self.bookmarks.event()

    def ns_of(self, at_s: float) -> int:
        """Return a time of pages as ns since the Unix epoch."""
        return self.zero_ns + round(at_s * _S)

    def note_progress(self, share: float | None) -> None:
        """Send how far the reading of a damaged or unfinished file is, 0 to 1; None: it ended."""
        self._progress = share
        self._send()

    # What is shown

    async def show(self, shown: ShownRecording | None, at_ns: int | None = None) -> None:
        """Show a recording, which is let go with the next one; None: show what runs now.

        Who waits for it may give that up: it is shown all the same, for what was shown before has
        to be let go.

        Args:
            shown: The recording.
            at_ns: Where it stands at first; None: at its beginning.
        """
        await asyncio.shield(self._spawn(self._show(shown, at_ns)))

    async def _show(self, shown: ShownRecording | None, at_ns: int | None) -> None:
        self._leave_queue()
        async with self._turn:
            if self._closed:
                await asyncio.to_thread(_end, None, shown)
                return
            if shown is None and self._shown is None:
                return
            before, self._shown = self._shown, shown
            source, self._playing = self._playing, None
            self._trouble = ""
            if shown is not None:
                self._begin(shown, at_ns)
            await asyncio.to_thread(self._source.show, self._playing)
            await asyncio.to_thread(_end, source, before)
            if not self._closed:
                await self._tell_switch()

    async def go_live(self) -> None:
        """Show what runs now."""
        await self.show(None)

    async def close(self) -> None:
        """Show nothing of a recording any more."""
        self._closed = True
        self._rewinding.unfollow(self.refresh)
        self._leave_queue()
        if self._telling is not None:
            self._telling.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)  # what is shown now is let go
        source, self._playing = self._playing, None
        shown, self._shown = self._shown, None
        if source is not None:
            await asyncio.to_thread(self._source.show, None)
        await asyncio.to_thread(_end, source, shown)

    def _begin(self, shown: ShownRecording, at_ns: int | None) -> None:
        recording = shown.recording
        if at_ns is not None:
            at_ns = max(recording.begin_ns, min(recording.end_ns, at_ns))
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
        self._send_topics()
        await self.bookmarks.turn()
        await self.on_switch()

    # The last minutes

    async def _go_back(self, at_ns: int) -> bool:
        """Show what ran; whether that can be had at once, for too many may be there."""
        if (shown := self.others()) is not None and (held := shown.hold()) is not None:
            await self.show(held, at_ns)
            return True
        self._seat_at_ns = at_ns
        if self._seat is None:
            self._seat = self._rewinding.ask(self._granted, self._send, self._past_ended)
        if self._seat.place:
            self._send()
            return False
        await self._take_seat()
        return True

    async def _take_seat(self) -> None:
        """Show the last minutes, unless the place was left meanwhile."""
        if (seat := self._seat) is not None:
            self._seat = None
            await self.show(seat.shown(), self._seat_at_ns)

    def _granted(self) -> None:
        self._spawn(self._take_seat())

    def _leave_queue(self) -> None:
        if (seat := self._seat) is not None:
            self._seat = None
            seat.leave()
            self._send()

    def _past_ended(self) -> None:
        """All that was kept is forgotten."""
        self._seat = None
        self._spawn(self._leave_past())

    async def _leave_past(self) -> None:
        async with self._turn:
            shown = self._shown
        if shown is not None and shown.mode == "past":
            await self.go_live()

    def refresh(self) -> None:
        """Send what is kept by now, and what others show; leave a place that nobody looks from."""
        if self._shown is not None and self._shown.mode == "bag":
            return
        if len(self._audience):
            self._left_s = None
            self._send()
            self._send_topics(only_news=True)
            if self.bookmarks.are_others:
                self._spawn(self.bookmarks.turn())
            return
        now_s = time.monotonic()
        self._left_s = self._left_s or now_s
        if now_s - self._left_s > _LEFT_S and (self._seat or self._shown):
            self._spawn(self.go_live())

    def _spawn(self, work: Coroutine[None, None, None]) -> asyncio.Task[None]:
        task = asyncio.create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task

    # Where it stands

    async def seek(self, command: SeekTime) -> None:
        """Show another moment; answered when it is drawn, or when it is waited for.

        Raises:
            StudioError: There is none, or it cannot be read.
        """
        await self.go_to(self.ns_of(command.at_s), settled=command.settled)

    async def go_to(self, at_ns: int, *, settled: bool = True) -> None:
        """Show another moment, ns since the Unix epoch; as `seek`."""
        if self._playing is not None or await self._go_back(at_ns):
            await self._jump(at_ns, settled=settled)

    async def step(self, command: StepTime) -> None:
        """Go to the next message of a topic, or the one before; without one it stays.

        Before what runs now, that is the last one that came.
        """
        async with self._stepping:
            was_live = self._playing is None
            if was_live and (command.forward or not await self._go_back(time.time_ns())):
                return
            source = self._demand()
            self._change(lambda head: replace(head, playing=False))
            from_ns = source.playhead.at_ns + (1 if was_live else 0)
            find = partial(_neighbour, source.recording, command, from_ns)
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
        recording = self._looked_at().recording
        range_ns = self.ns_of(command.begin_s), self.ns_of(command.end_s)
        topic, bins = command.topic, command.bins
        async with self._counting:
            counts = await asyncio.to_thread(_counts, recording, topic, range_ns, bins)
        return TimeMarks(request=command.request, counts=tuple(counts.tolist()))

    async def ticks(self, command: GetTimeTicks) -> TimeTicks:
        """Return the errors and warnings that are known so far, and read a little further."""
        shown = self._looked_at()
        found, more, done = await asyncio.to_thread(shown.ticks.read)
        ticks = tuple(_tick_view(one, shown.zero_ns) for one in found)
        return TimeTicks(request=command.request, ticks=ticks, more=more, done=done)

    @contextmanager
    def held(self) -> Generator[ShownRecording]:
        """Hold what the timeline is about while parts of it are written.

        Raises:
            CommandError: There is nothing.
        """
        held = self._looked_at().hold()
        if held is None:
            raise CommandError(_LIVE)
        try:
            yield held
        finally:
            asyncio.get_running_loop().run_in_executor(None, held.let_go)

    def _looked_at(self) -> ShownRecording:
        """Return what the timeline is about: what is shown, or what can be gone back to.

        Raises:
            CommandError: There is nothing.
        """
        return self._shown or self.others() or self._rewinding.looked_at()

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

    def _send_topics(self, *, only_news: bool = False) -> None:
        """Send the topics, if that is due: their counts grow with each message."""
        topics, now_s = self._topics(), time.monotonic()
        names = tuple((one.name, one.note) for one in topics)
        told_s, told = self._told_topics
        is_due = names != told or (now_s - told_s > _TOPICS_EVERY_S and len(names) < _TOPICS_OFTEN)
        if is_due or not only_news:
            self._told_topics = now_s, names
            self._audience.send(_topics_event(topics))

    def _topics(self) -> Sequence[RecordedTopic]:
        shown = self._shown or self.others()
        if shown is not None and shown.mode == "bag":
            return shown.recording.topics
        return self._rewinding.facts.topics

    def _state(self) -> TimeState:
        source, shown = self._playing, self._shown or self.others()
        head = source.playhead if source is not None else _AT_LIVE
        begin_ns, end_ns, troubles = self._span(shown)
        loop = head.loop and (self._s_of(head.loop[0]), self._s_of(head.loop[1]))
        said = (self._trouble, *troubles[:_TROUBLES_MAX])
        is_bag = shown is not None and shown.mode == "bag" and source is not None
        return TimeState(
            mode="live" if source is None or self._shown is None else self._shown.mode,
            title=shown.title if shown else "",
            path=shown.path if shown else "",
            zero_s=self.zero_ns / _S,
            begin_s=self._s_of(begin_ns),
            end_s=self._s_of(end_ns),
            now_s=self._s_of(head.at_ns if source is not None else end_ns),
            playing=head.playing,
            rate=head.rate,
            loop=loop,
            skipping=source is not None and source.is_skipping,
            queue=self._seat.place if self._seat is not None else 0,
            progress=self._progress,
            troubles=tuple(one[:_SENTENCE_MAX] for one in said if one),
            kept_bytes=0 if is_bag else self._rewinding.facts.size,
            kept_bytes_max=0 if is_bag else self._rewinding.past.size_max,
        )

    def _span(self, shown: ShownRecording | None) -> tuple[int, int, Sequence[str]]:
        """Return when it begins and ends, and what is left out of it."""
        if shown is not None and shown.mode == "bag":
            recording = shown.recording
            troubles = (*shown.troubles, *recording.troubles)
            return recording.begin_ns, recording.end_ns, troubles
        facts = self._rewinding.facts
        # A page counts on by itself, though nothing may come.
        end_ns = max(facts.end_ns, time.time_ns()) if facts.end_ns else 0
        return facts.begin_ns, end_ns, facts.troubles

    def _s_of(self, at_ns: int) -> float:
        return (at_ns - self.zero_ns) / _S


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
    known = [one.name for one in recording.topics]
    names = [one for one in known if command.topic in {"", one}]
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


def _topics_event(topics: Sequence[RecordedTopic]) -> TimeTopics:
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
            for one in topics[:_TOPICS_MAX]
        )
    )


def _tick_view(tick: Tick, zero_ns: int) -> TimeTick:
    at_s = (tick.at_ns - zero_ns) / _S
    return TimeTick(at_s=at_s, level=tick.level, source=tick.source, text=tick.text)


_SEEKS: Final = Limits(per_second=120)
_MARKS: Final = Limits(per_second=30)
_TICKS: Final = Limits(per_second=10)

COMMANDS: Final = Commands[DocumentTime](Scope.DOCUMENT)
COMMANDS.controller(GoLive, lambda time, _, __: time.go_live())
COMMANDS.controller(SeekTime, lambda time, c, _: time.seek(c), limits=_SEEKS)
COMMANDS.controller(PlayTime, lambda time, c, _: time.play(c))
COMMANDS.controller(SetTimeRate, lambda time, c, _: time.set_rate(c))
COMMANDS.controller(StepTime, lambda time, c, _: time.step(c), limits=_SEEKS)
COMMANDS.controller(LoopTime, lambda time, c, _: time.loop(c))
COMMANDS.viewer(GetTimeMarks, lambda time, c, _: time.marks(c), limits=_MARKS)
COMMANDS.viewer(GetTimeTicks, lambda time, c, _: time.ticks(c), limits=_TICKS)
COMMANDS.include(BOOKMARK_COMMANDS, lambda time, _: time.bookmarks)
COMMANDS.include(SERIES_COMMANDS, lambda time, _: time.series)
