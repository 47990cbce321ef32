"""The origin's end of one line: what the relay asks for, asked again here, and what it gets."""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final, Protocol, TypeVar

from pydantic import ValidationError

from studio.documents.engine import COMMANDS
from studio.documents.exports import Download
from studio.errors import (
    CommandError,
    NotJoiningError,
    RelayLineError,
    StudioError,
    TicketError,
    UnknownDocumentError,
)
from studio.outlet import Outlet
from studio.protocol.calls import FollowOperations
from studio.protocol.changes import FollowChanges
from studio.protocol.classroom import Follow
from studio.protocol.commands import demand
from studio.protocol.documents import Refused
from studio.protocol.listeners import encode as encode_event
from studio.protocol.listeners import send
from studio.protocol.message import Command
from studio.protocol.roles import owner_of
from studio.server.access import ROUTES
from studio.server.commands import answer, malformed, request_of
from studio.server.crowd import Allowance
from studio.server.relays.messages import (
    CHANGES,
    OPERATIONS,
    STUDIO_LANE,
    Arrive,
    Ask,
    AskDownload,
    AskJoin,
    AskTopic,
    CloseLane,
    CloseScene,
    Downloaded,
    EndPerson,
    Frame,
    Joined,
    LaneClosed,
    Leave,
    OpenLane,
    OpenScene,
    Ping,
    Pong,
    Refresh,
    Say,
    SceneClosed,
    Settled,
    Taken,
    Viewers,
    WantBlobs,
    decode_up,
    encode,
)
from studio.server.relays.origin_lanes import OriginLane, OriginScene, RelayedPage
from studio.server.relays.origin_topics import TopicsOfRelay
from studio.server.surface import OpenDocuments

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from studio.protocol.listeners import Listener
    from studio.protocol.roles import Person
    from studio.server.relays.line import Line
    from studio.server.relays.messages import RoomState, Up

RUNNING_MAX: Final = 256
"""Commands of one relay that run; what comes meanwhile is refused."""
LANES_MAX: Final = 700
"""And as many 3D views: each person of a class may look at a copy of their own."""
_OPENING_MAX: Final = 2 * LANES_MAX
PAGES_MAX: Final = 4_000
"""Pages of one relay that are known one by one: members', and those that asked for something."""
_DOWNLOAD_BYTES_MAX: Final = 48 << 20
_DOWNLOADS_AT_ONCE: Final = 2
_REST_S_MAX, _SCENE_S = 0.1, 0.01
_STATE_EVERY_S: Final = 0.5
_UNITS_PER_S, _UNITS_AT_ONCE = 3_000.0, 6_000.0
"""Messages of a relay: thirty classes type no more."""
_log = logging.getLogger(__name__)


class SharedStudio(OpenDocuments, Protocol):
    """The engine, as far as a relay reaches it."""

    async def watch(self, name: str, listener: Listener, /) -> None:
        """Send a listener the state of a document, and what changes."""
        ...

    def arrive(self, listener: Listener, /) -> None:
        """A page is there, which has from elsewhere what all pages are sent."""
        ...


class OwnRoom(Protocol):
    """The room of the origin, which all its relays serve."""

    @property
    def shown(self) -> str:
        """The copy that everybody may see; empty: none."""
        ...

    def state(self, relay: str, /) -> RoomState:
        """Return what a relay must know of it."""
        ...

    def person(self, ticket: str, /) -> Person:
        """Return whose ticket it is.

        Raises:
            TicketError: Nobody's who may be here.
        """
        ...

    async def join(self, relay: str, form: AskJoin, /) -> str:
        """Add a person, and return their ticket.

        Raises:
            NotJoiningError: They may not join.
        """
        ...

    def has(self, person: Person, /) -> bool:
        """Whether a person may still be here."""
        ...

    def tickets(self) -> bytes:
        """Return the public key of those who sign tickets."""
        ...


class OriginEnd:
    """Used on the event loop only; whatever comes may be forged, and costs within bounds.

    Args:
        engine: The studio.
        room: Whom it knows.
        line: To the relay.
        relay: The relay's name.
        hang_up: Ends the line: the relay is refused for good if a reason is given.
        allows: Whether a topic is forwarded.
    """

    def __init__(
        self,
        engine: SharedStudio,
        room: OwnRoom,
        line: Line,
        *,
        relay: str,
        hang_up: Callable[[str], None],
        allows: Callable[[str], bool],
    ) -> None:
        self._engine, self._room, self._line, self._relay = engine, room, line, relay
        self._hang_up = hang_up
        self.outlet = Outlet(line, on_hopeless=lambda: hang_up(""))
        line.on_drain(self.outlet.resume)
        self._sent: RoomState | None = None
        self._lanes: dict[str, OriginLane] = {}
        self._scenes: dict[str, OriginScene] = {}
        self._pages: dict[int, RelayedPage] = {}
        self._viewers = Viewers(0, 0)
        self._topics = TopicsOfRelay(engine.browser_topics, line.send, line, allows)
        line.on_drain(self._topics.resume)
        self._allowance = Allowance(_UNITS_PER_S, _UNITS_AT_ONCE)
        self._running: set[asyncio.Task[None]] = set()
        """What was asked for and is not answered."""
        self._serving: set[asyncio.Task[None]] = set()
        self._opening: dict[tuple[str, str], asyncio.Task[None]] = {}
        """Lanes and 3D views that are on their way, or views that are shown, by kind and name."""
        self._turns, self._free_s = asyncio.Lock(), 0.0
        self._downloads = asyncio.Semaphore(_DOWNLOADS_AT_ONCE)
        self._is_open = True
        self.tell_state()
        self._ticking = self._start(self._tick(), self._serving)

    def take(self, data: bytes) -> None:
        """Carry out a message of the relay; one that is none ends the line."""
        try:
            message = decode_up(data)
            self._carry_out(message)
        except StudioError as error:
            _log.warning("%s", error)
            self._hang_up("")

    def missed(self) -> None:
        """End the line: what was asked is asked again on the next, by the same ids."""
        self._hang_up("")

    def people(self) -> int:
        """Return how many pages are open at the relay."""
        return self._viewers.pages

    @property
    def guests(self) -> int:
        """Pages at the relay of people who are not in the class."""
        return self._viewers.guests

    def end_person(self, person: str) -> None:
        """Have the relay end a person's pages; whether it does or not, they are nobody's here."""
        self.tell_state()
        self._forget_pages(lambda page: page.person == person)
        self.outlet.post(encode(EndPerson(person)))

    def tell_state(self) -> None:
        """Send what the relay must know of the room, if that is not what it knows."""
        state = self._room.state(self._relay)
        before = self._sent
        if state == before:
            return
        self._sent = state
        self.outlet.post(encode(state))
        if before is not None and before.tickets != state.tickets:
            self._forget_pages(lambda _: True)  # all were logged out
            self._review(lambda _: False)

    def close(self) -> None:
        """The line has ended: nobody is there by it any more."""
        self._is_open = False
        for task in (*self._running, *self._serving):
            task.cancel()
        for scene in self._scenes.values():
            scene.close()
        for listener in (*self._lanes.values(), *self._pages.values()):
            self._engine.detach(listener)
        self._topics.close()
        self.outlet.close()
        self._viewers = Viewers(0, 0)

    def _carry_out(self, message: Up) -> None:  # noqa: C901, PLR0912 - one each
        match message:
            case Ask():
                self._ask(message)
            case Ping():
                self._line.send(Pong(message.sent_ns))
            case AskTopic():
                self._topics.carry_out(message, self._person_of(message.ticket))
            case WantBlobs():
                if scene := self._scenes.get(message.document):
                    scene.wanted(message.opening, message.digests)
            case OpenLane():
                sees = self._sight_of(message.lane, self._person_of(message.ticket))
                self._open(_LANE, message.lane, self._open_lane(message.lane, sees))
            case Refresh():
                if message.lane in self._lanes and (_LANE, message.lane) not in self._opening:
                    self._open(_LANE, message.lane, self._refresh(message.lane))
            case CloseLane():
                self._close_lane(message.lane)
            case OpenScene():
                sees = self._sight_of(message.document, self._person_of(message.ticket))
                work = self._open_scene(message.document, message.opening, sees)
                self._open(_SCENE, message.document, work)
            case CloseScene():
                self._close_scene(message.document)
            case Arrive():
                self._arrive(message)
            case Leave():
                if page := self._pages.pop(message.page, None):
                    self._engine.detach(page)
            case Viewers():
                self._viewers = message
            case AskJoin() | AskDownload() if len(self._running) >= RUNNING_MAX:
                self.outlet.post(encode(_too_much(message)))
            case AskJoin():
                self._start(self._join(message), self._running)
            case AskDownload():
                self._start(self._download(message), self._running)
            case Taken():
                self._hang_up(message.reason[:200])

    def _person_of(self, ticket: str) -> Person | None:
        """Return whose ticket it is: nobody's that is not valid, who sees what all may see."""
        try:
            return self._room.person(ticket) if ticket else None
        except TicketError as error:
            _log.info("A relay asked with a ticket that is not valid: %s", error)
            return None

    def _start(
        self, work: Coroutine[object, object, None], among: set[asyncio.Task[None]]
    ) -> asyncio.Task[None]:
        task = asyncio.get_running_loop().create_task(work)
        among.add(task)

        def ended(task: asyncio.Task[None]) -> None:
            among.discard(task)
            if not task.cancelled() and (error := task.exception()) is not None:
                _log.error("What a relay asked for failed.", exc_info=error)
                self._hang_up("")

        task.add_done_callback(ended)
        return task

    # Lanes

    def _open(self, kind: str, name: str, work: Coroutine[object, object, None]) -> None:
        """Open a lane or a 3D view; of one name the last that was asked for counts."""
        self._cancel(kind, name)
        if len(self._opening) >= _OPENING_MAX:
            work.close()
            raise RelayLineError("the relay asks for more at once than a relay needs.")
        task = self._opening[kind, name] = self._start(work, self._serving)

        def ended(task: asyncio.Task[None]) -> None:
            if self._opening.get((kind, name)) is task:
                del self._opening[kind, name]

        task.add_done_callback(ended)

    def _cancel(self, kind: str, name: str) -> None:
        if task := self._opening.pop((kind, name), None):
            task.cancel()

    async def _turn(self) -> float:
        """Wait until the whole state of something may be made: one at a time, and with rests."""
        loop = asyncio.get_running_loop()
        async with self._turns:
            await asyncio.sleep(max(0.0, self._free_s - loop.time()))
            self._free_s = loop.time() + _SCENE_S
        return loop.time()

    async def _open_lane(self, name: str, sees: Callable[[str], bool]) -> None:
        self._forget_lane(name)
        lane = OriginLane(name, self.outlet, self.tell_state, sees, self._lane_ended)
        try:
            await self._fill(lane)
        except StudioError as error:
            self._engine.detach(lane)
            self.outlet.post(encode(LaneClosed(name, str(error))))
        except BaseException:
            self._engine.detach(lane)
            raise
        else:
            self._lanes[name] = lane

    async def _refresh(self, name: str) -> None:
        try:
            if lane := self._lanes.get(name):
                await self._fill(lane)
        except StudioError as error:
            self._forget_lane(name)
            self.outlet.post(encode(LaneClosed(name, str(error))))

    def _lane_ended(self, lane: OriginLane) -> None:
        """Its document is closed: what is opened under that name later is another."""

        def end() -> None:
            if self._lanes.get(lane.lane) is lane and self._is_open:
                self._close_lane(lane.lane)
                reason = str(UnknownDocumentError(lane.lane))
                self.outlet.post(encode(LaneClosed(lane.lane, reason)))

        asyncio.get_running_loop().call_soon(end)

    def _close_lane(self, name: str) -> None:
        self._cancel(_LANE, name)
        self._forget_lane(name)

    def _forget_lane(self, name: str) -> None:
        if lane := self._lanes.pop(name, None):
            self._engine.detach(lane)

    async def _fill(self, lane: OriginLane) -> None:
        """Send a lane's whole state, and every change from then on.

        Raises:
            StudioError: There is no such thing, or it may not be seen.
        """
        name = lane.lane
        if name not in self._lanes and len(self._lanes) >= LANES_MAX:
            raise CommandError("More is open at this relay than it may show: close a page.")
        if owner_of(name) and lane.sees(name):
            await self._engine.ready(name)
        began_s = await self._turn()
        if name == STUDIO_LANE:
            lane.begin_snapshot()
            self._engine.attach(lane)
            await self._follow(lane, Follow(following=True))
        elif name.startswith(CHANGES):
            command = _checked(FollowChanges, subject=name.removeprefix(CHANGES))
            lane.begin_snapshot()
            await self._follow(lane, command)
        elif name.startswith(OPERATIONS):
            command = _checked(FollowOperations, operations=name.removeprefix(OPERATIONS))
            lane.begin_snapshot()
            await self._follow(lane, command)
        else:
            if not lane.sees(name):
                raise UnknownDocumentError(name)
            await self._engine.ready(name)
            lane.begin_snapshot()
            await self._engine.watch(name, lane)
        lane.end_snapshot()
        now_s = asyncio.get_running_loop().time()
        self._free_s = max(self._free_s, now_s + min(now_s - began_s, _REST_S_MAX))

    async def _follow(self, lane: OriginLane, command: Command) -> None:
        answered = await COMMANDS.carry_out(self._engine, command, lane)  # type: ignore[arg-type]
        if answered is not None:
            send(lane, answered)

    def _sight_of(self, name: str, person: Person | None) -> Callable[[str], bool]:
        tickets = self._room.tickets()

        def sees(document: str) -> bool:
            if not owner_of(document) or document == self._room.shown:
                return True
            if person is None:
                return False
            is_here = self._room.has(person) and self._room.tickets() == tickets
            return document == name and is_here and person.sees(document)

        return sees

    def _review(self, has: Callable[[Person], bool]) -> None:
        """End what may not be seen any more."""
        for name, lane in tuple(self._lanes.items()):
            if owner_of(name) and not lane.sees(name):
                self._close_lane(name)
                self.outlet.post(encode(LaneClosed(name, str(UnknownDocumentError(name)))))
        self._topics.review(has)

    def _close_scene(self, document: str) -> None:
        if scene := self._scenes.get(document):
            scene.close()
        else:
            self._cancel(_SCENE, document)

    async def _open_scene(self, document: str, opening: int, sees: Callable[[str], bool]) -> None:
        try:
            if not sees(document) or len(self._scenes) >= LANES_MAX:
                raise UnknownDocumentError(document)
            scene = (await self._engine.ready(document)).scene
        except StudioError:
            self.outlet.post(encode(SceneClosed(document)))
            return
        await self._turn()
        shown = self._scenes[document] = OriginScene(
            document, opening, self._line, lambda: sees(document)
        )
        try:
            await shown.serve(scene)
        finally:
            if self._scenes.get(document) is shown:
                del self._scenes[document]
        if self._is_open:
            self.outlet.post(encode(SceneClosed(document)))

    # People

    def _arrive(self, message: Arrive) -> None:
        if message.page in self._pages or len(self._pages) >= PAGES_MAX:
            raise RelayLineError("the relay opens a page twice, or too many.")
        if (person := self._person_of(message.ticket)) is None:
            return
        page = RelayedPage(message.page, person, self.outlet, self.tell_state)
        self._pages[message.page] = page
        self._engine.arrive(page)

    def _forget_pages(self, of: Callable[[RelayedPage], bool]) -> None:
        for page in [one for one in self._pages.values() if of(one)]:
            del self._pages[page.page]
            self._engine.detach(page)

    def _ask(self, message: Ask) -> None:
        if self._sent is None or self._room.tickets() != self._sent.tickets:
            self.tell_state()
        page = self._pages.get(message.page)
        loop = asyncio.get_running_loop()
        units = 1 + len(message.text) / 1024
        pause_s = self._allowance.spend(units, loop.time())
        if page is None or not self._room.has(page.visitor):
            self._refuse(message, "You are not in this class any more: join it again.")
        elif len(self._running) >= RUNNING_MAX or pause_s > 1:
            # Not counted: else one who floods would have all others refused for long after.
            self._allowance.spend(-units, loop.time())
            self._refuse(message, _TOO_MUCH)
        else:
            self._start(self._answer(page, message), self._running)

    def _refuse(self, message: Ask, reason: str) -> None:
        request = request_of(message.text)
        refusal = encode_event(Refused(request=request, kind=CommandError.__name__, reason=reason))
        self.outlet.post(encode(Say(message.page, Frame(refusal))))
        self.outlet.post(encode(Settled(message.page, message.number)))

    async def _answer(self, page: RelayedPage, message: Ask) -> None:
        await answer(self._engine, page, message.text)
        self.outlet.post(encode(Settled(message.page, message.number)))

    async def _join(self, form: AskJoin) -> None:
        try:
            joined = Joined(form.number, await self._room.join(self._relay, form))
        except NotJoiningError as error:
            joined = Joined(form.number, "", error.why, str(error))
        self.tell_state()
        self.outlet.post(encode(joined))

    async def _download(self, message: AskDownload) -> None:
        try:
            person = self._room.person(message.ticket)
            demand(person, ROUTES.get(_ROUTE.format(message.what)), message.document)
            async with self._downloads:
                found = await self._made(message)
                data = await asyncio.to_thread(_joined, found)
        except StudioError as error:
            failed = Downloaded(message.number, kind=type(error).__name__, reason=str(error))
            self.outlet.post(encode(failed))
            return
        self._line.send(Downloaded(message.number, found.name, found.media_type, data))

    async def _made(self, message: AskDownload) -> Download:
        options = list(message.options)
        document = self._engine.document(message.document)
        if message.what == "page":
            return await document.exports.page(dark=("theme", "dark") in options)
        if message.what == "series":
            table = await document.time.series.table(options)
            return Download("plot.csv", "text/csv", table)
        raise CommandError("This is given out by the studio itself, not by a relay.")

    async def _tick(self) -> None:
        """Tell what changed though nothing was said to pages."""
        while True:
            await asyncio.sleep(_STATE_EVERY_S)
            self.tell_state()
            self._review(self._room.has)


_LANE, _SCENE = "lane", "scene"
_TOO_MUCH: Final = "Too much is asked for by this relay at once: try again soon."
_ROUTE: Final = "/api/documents/{{document}}/export/{}"
_Followed = TypeVar("_Followed", bound=Command)


def _checked(kind: type[_Followed], **fields: str) -> _Followed:
    """Return a command of what a relay names.

    Raises:
        CommandError: It names nothing that can be followed.
    """
    try:
        return kind(**fields)  # type: ignore[arg-type]
    except ValidationError as error:
        raise CommandError(malformed("lane", error)) from None


def _too_much(message: AskJoin | AskDownload) -> Joined | Downloaded:
    if isinstance(message, AskJoin):
        return Joined(message.number, "", "tries", _TOO_MUCH)
    return Downloaded(message.number, kind=CommandError.__name__, reason=_TOO_MUCH)


def _joined(download: Download) -> bytes:
    """Return all bytes of a download.

    Raises:
        CommandError: There are more than a relay passes on.
    """
    data = bytearray()
    for chunk in download.chunks:
        data += chunk
        if len(data) > _DOWNLOAD_BYTES_MAX:
            raise CommandError("This is too large for a relay: ask the presenter for it.")
    return bytes(data)
