"""A Room at a relay: in the place of the engine behind the server's routes and lanes.

It holds what the origin sent, shows it to pages, and passes on what they ask. While the origin is
away, pages keep what they have.
"""

from __future__ import annotations

import asyncio
import itertools
import logging
from collections import deque
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.documents.exports import Download
from studio.errors import (
    CommandError,
    NotJoiningError,
    OriginAwayError,
    RelayLineError,
    StudioError,
    UnknownDocumentError,
)
from studio.protocol.calls import FollowOperations
from studio.protocol.changes import FollowChanges
from studio.protocol.classroom import Follow, You
from studio.protocol.documents import Done, Watch
from studio.protocol.listeners import send
from studio.protocol.relays import RelayState
from studio.protocol.roles import Role, owner_of
from studio.server.data_lane import DataLane
from studio.server.relays.messages import (
    CHANGES,
    NAME_LETTERS_MAX,
    OPERATIONS,
    VIEWER,
    Arrive,
    AskDownload,
    AskJoin,
    Blob,
    Downloaded,
    EndPerson,
    Joined,
    LaneClosed,
    LaneFrame,
    LaneSnapshot,
    Leave,
    Ping,
    Pong,
    RoomState,
    Say,
    SceneClosed,
    SceneFrame,
    Settled,
    Taken,
    TopicState,
    TopicTick,
    Viewers,
    decode_down,
)
from studio.server.relays.passed_on import PassedOn
from studio.server.relays.questions import Questions
from studio.server.relays.relayed_class import RelayedClass, RelayedMember
from studio.server.relays.relayed_lanes import RelayedLanes
from studio.server.relays.relayed_scenes import RelayedScenes
from studio.server.relays.relayed_topics import RelayedTopics
from studio.server.relays.room_documents import OnlyThere, RoomDocument
from studio.server.relays.shared_reads import SharedReads, is_shared
from studio.server.relays.standing import Standing
from studio.server.relays.tickets import TICKET_LETTERS_MAX

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from studio.live.topics.browsers import DataLaneEnd
    from studio.protocol import Command
    from studio.protocol.listeners import Listener
    from studio.protocol.roles import Person
    from studio.scene.frame_parts import BlobStore
    from studio.server.relays.line import Line
    from studio.server.relays.messages import Down, Up

PATIENCE_S: Final = 3.0
"""So long after the origin went, what is asked waits for its return; then it is refused at once."""
_MEDIA_TYPES: Final = frozenset({"text/html; charset=utf-8", "text/csv"})
_ANY_BYTES: Final = "application/octet-stream"
_GIVE_UP_S: Final = 90.0
"""So long an answer is waited for that was asked for before the origin went."""
_TICK_S: Final = 1.0
_GREETING_S: Final = 15.0
"""So long after it claimed its room an origin has time to say what the room is."""
_REPLACED_MAX: Final = 16
_YOU: Final = b'{"type":"you"'
_log = logging.getLogger(__name__)


class Room:
    """Used on the event loop only.

    Args:
        name: The room's.
        blobs: Large parts of 3D views, of all rooms.
        end_people: Ends all connections of some people.
    """

    def __init__(
        self,
        name: str,
        blobs: BlobStore,
        end_people: Callable[[Callable[[Person], bool]], object],
    ) -> None:
        self.name, self._end_people = name, end_people
        self._line: Line | None = None
        self._loop = asyncio.get_running_loop()
        self._pages: dict[Listener, int] = {}
        """All control lanes, and those that ask by HTTP."""
        self.classroom = RelayedClass(name, self._join)
        self.lanes = RelayedLanes(self._send, self._ticket_for)
        self.scenes = RelayedScenes(self._send, self._ticket_for, blobs)
        self.browser_topics = RelayedTopics(self._send, self._ticket_of)
        self.uploads = self.copies = OnlyThere()
        self._greeted, self._greet_by_s = False, 0.0
        self._before_bytes = [0, 0, 0]
        """Received, sent and refused on lines that have ended."""
        self._arrived: set[int] = set()
        """Pages that the origin knows one by one."""
        self._by_number: dict[int, Listener] = {}
        self._numbers = itertools.count(1)
        self._passed_on = PassedOn(self._send)
        self._standing = Standing()
        self._renewing: set[asyncio.Task[None]] = set()
        self._reads = SharedReads(self._pass_on, self.detach, lambda: self.lanes.frame_count)
        self._joining = Questions[Joined](self._send, _JOINING_MAX)
        self._downloading = Questions[Downloaded](self._send, _DOWNLOADING_MAX)
        self._sent_viewers = Viewers(0, 0)
        self.away_since_s = self._loop.time()
        self.replaced: deque[str] = deque(maxlen=_REPLACED_MAX)
        """Sessions of studios that had the room until another claimed it; they have it no more,
        also if their line was cut when that one came."""
        self.dial = ""
        """By which address of this relay its studio came."""
        self.round_trip_s = 0.0
        self._ticking = self._loop.create_task(self._tick())

    # The origin

    @property
    def is_there(self) -> bool:
        """Whether the origin is, and has said what room it has."""
        return self._line is not None and self._greeted

    @property
    def line(self) -> Line | None:
        """To the origin, while it is there."""
        return self._line

    @property
    def pages(self) -> int:
        """How many are open."""
        return len(self.lanes.studio.listeners)

    @property
    def people(self) -> int:
        """How many persons have one open."""
        return len({one.person for one in self.lanes.studio.listeners})

    @property
    def frame_count(self) -> int:
        """Frames that came, of all lanes."""
        return self.lanes.frame_count + self.scenes.frame_count

    @property
    def received_bytes(self) -> int:
        """Bytes that came from the origin."""
        return self._before_bytes[0] + (self._line.received_bytes if self._line else 0)

    @property
    def sent_bytes(self) -> int:
        """Bytes that went to the origin."""
        return self._before_bytes[1] + (self._line.sent_bytes if self._line else 0)

    @property
    def refused(self) -> int:
        """Messages that were forged, sent again or out of their order."""
        return self._before_bytes[2] + (self._line.refused if self._line else 0)

    @property
    def session(self) -> str:
        """Of the run of the studio; empty: it has not said it."""
        return self.state.session if self.state else ""

    @property
    def state(self) -> RoomState | None:
        """What the origin said last of the room."""
        return self.classroom.state

    def connect(self, line: Line) -> None:
        """The origin claimed the room; once it says what that is, what was missed is asked for."""
        self._line = line
        self._arrived.clear()
        self._sent_viewers = Viewers(0, 0)
        self._greeted, self._greet_by_s = False, self._loop.time() + _GREETING_S
        line.begin(self)

    def hang_up(self, reason: str = "") -> None:
        """End the line; `reason` tells the origin not to come again, and none to dial anew."""
        line, self._line = self._line, None
        if line is None:
            return
        line.send(Taken(reason))
        self.away_since_s = self._loop.time()
        for at, count in enumerate((line.received_bytes, line.sent_bytes, line.refused)):
            self._before_bytes[at] += count
        line.close()
        self._joining.give_up()
        self._downloading.give_up()
        self.browser_topics.reset()
        self.scenes.reset()
        self._tell_all()

    async def close(self) -> None:
        """End it."""
        self.hang_up()
        self._ticking.cancel()
        self.scenes.close()
        self._passed_on.refuse_all(OriginAwayError())

    def take(self, data: bytes) -> None:
        """Take a message of the origin; one that is none ends the line."""
        try:
            self._carry_out(decode_down(data))
        except (StudioError, ValueError) as error:  # or what it says to a page cannot be read
            _log.warning("%s", error)
            self.hang_up()

    def missed(self) -> None:
        """End the line: the origin dials again, and sends all anew."""
        self.hang_up()

    def _carry_out(self, message: Down) -> None:  # noqa: C901, PLR0912 - one line each
        if not self._greeted and not isinstance(message, RoomState):
            raise RelayLineError("the studio has not said what room it has.")
        match message:
            case LaneFrame():
                self.lanes.take_frame(message)
            case SceneFrame():
                self.scenes.take(message)
            case TopicTick():
                self.browser_topics.take_tick(message)
            case Say():
                self._say(message)
            case Settled():
                self._passed_on.settle(message.number)
            case RoomState():
                self._renew(message)
            case LaneSnapshot():
                self.lanes.take_snapshot(message)
            case LaneClosed():
                self.lanes.close(message.lane, message.reason)
            case Blob():
                self.scenes.take_blob(message)
            case SceneClosed():
                self.scenes.end(message.document)
            case TopicState():
                self.browser_topics.take_state(message.text)
            case Pong():
                self.round_trip_s = (self._now_ns() - message.sent_ns) / 1e9
            case EndPerson():
                self._end_people(partial(self.classroom.is_person, message.person))
            case Joined():
                self._joining.answer(message)
            case Downloaded():
                self._downloading.answer(message)

    def _send(self, message: Up) -> bool:
        """Send a message; answers whether there is a line."""
        if self._line is None or not self._greeted:
            return False
        self._line.send(message)
        return True

    def _renew(self, state: RoomState) -> None:
        """Take what the room is now; on a new line, ask for all anew that is looked at."""
        before = self.classroom.state
        self.classroom.renew(state)
        self._review(before)
        if self._greeted:
            if before is not None and before.others != state.others:
                self._tell_all()
            return
        self._greeted = True
        if before is not None and before.session != state.session:
            self._passed_on.refuse_sent()
            # As after any restart of a studio, pages come again, and ask anew for what they show.
            self._end_people(self.classroom.is_here)
        for listener in tuple(self._pages):
            if self._is_known(listener):
                self._arrive(listener)
        self.lanes.renew()
        self.scenes.renew()
        self.browser_topics.renew()
        self._passed_on.ask_again(self._arrive)
        for listener in tuple(self._pages):
            task = self._loop.create_task(self._ask_standing(listener))
            self._renewing.add(task)
            task.add_done_callback(self._renewing.discard)
        self._tell_all()

    def _review(self, before: RoomState | None) -> None:
        """End the pages of who may not be here any more, and what is not to be seen any more."""
        state = self.classroom.state
        if before is None or state is None or before == state:
            return
        here = (before.is_open, before.sent_out, before.tickets)
        if here != (state.is_open, state.sent_out, state.tickets):
            self._end_people(self.classroom.is_out)
        if before.shown != state.shown:
            self.lanes.review()

    async def _ask_standing(self, listener: Listener) -> None:
        """Ask again for what lasts, one after the other: a lesson before the panels seen in it."""
        for command in self._standing.of(listener):
            with suppress(StudioError):
                await self._pass_on(command, listener)

    # Pages

    def attach(self, listener: Listener) -> None:
        """Show a new page what every page is shown, and who it is."""
        self._number_of(listener)
        send(listener, self._relay_state(listener))
        self.lanes.studio.add(listener)
        if member := self.classroom.person(listener.person):
            has_control = member.controls("")
            send(
                listener,
                You(
                    person=member.person,
                    name=member.name,
                    role=member.role.value,  # type: ignore[arg-type]
                    has_control=has_control,
                ),
            )
        if self._is_known(listener):
            self._arrive(listener)

    def detach(self, listener: Listener) -> None:
        """Forget a page."""
        self.lanes.forget(listener)
        page = self._pages.pop(listener, None)
        if page is None:
            return
        self._by_number.pop(page, None)
        self._standing.forget(listener)
        self._passed_on.leave(page)
        if page in self._arrived:
            self._arrived.discard(page)
            self._send(Leave(page))

    def _is_known(self, listener: Listener) -> bool:
        """Whether the origin keeps a list of such people: all but those beyond its places."""
        return not listener.person.startswith(VIEWER)

    def _number_of(self, listener: Listener) -> int:
        """Return a page's number, which it is given if it has none."""
        page = self._pages.get(listener)
        if page is None:
            page = self._pages[listener] = next(self._numbers)
            self._by_number[page] = listener
        return page

    def _arrive(self, listener: Listener) -> int:
        """Have the origin know a page; answers its number."""
        page = self._number_of(listener)
        member = self.classroom.person(listener.person)
        if page not in self._arrived and member is not None and self._line is not None:
            self._arrived.add(page)
            self._send(Arrive(page, member.ticket))
        return page

    def _relay_state(self, listener: Listener) -> RelayState:
        state, member = self.classroom.state, self.classroom.person(listener.person)
        return RelayState(
            studio="there" if self.is_there else "away",
            others=tuple(f"{one}join?pass={member.ticket}" for one in state.others)
            if state and member
            else (),
        )

    def _tell_all(self) -> None:
        for listener in tuple(self._pages):
            send(listener, self._relay_state(listener))

    def _say(self, message: Say) -> None:
        listener = self._by_number.get(message.page)
        if listener is None:
            return
        frame = message.frame
        if frame.data.startswith(_YOU):
            self.classroom.note(frame.data)
            self.lanes.review()
        listener.post(frame.data, binary=frame.binary, key=frame.key or None)

    # Commands

    async def execute(self, command: Command, listener: Listener) -> None:
        """Do what a relay does by itself, and pass on the rest.

        Raises:
            StudioError: It cannot be done.
        """
        if isinstance(command, Watch):
            self.check(command.document)
            self.lanes.leave(listener)
            await self.lanes.watch(command.document, listener)
        elif isinstance(command, FollowChanges):
            await self._follow(CHANGES + command.subject, listener, following=command.following)
        elif isinstance(command, FollowOperations):
            name = OPERATIONS + command.operations
            await self._follow(name, listener, following=command.following)
        elif is_shared(command, listener):
            await self._reads.answer(command, listener)
            return
        elif isinstance(command, Follow) and not self._is_known(listener):
            self.lanes.studio.follow(listener, following=command.following)
        else:
            if isinstance(command, Follow):
                self.lanes.studio.follow(listener, following=command.following)
            self._standing.note(command, listener)
            await self._pass_on(command, listener)
            return
        send(listener, Done(request=command.request))

    async def _follow(self, name: str, listener: Listener, *, following: bool) -> None:
        self.lanes.unfollow(name, listener)
        if following:
            await self.lanes.watch(name, listener)

    async def _pass_on(self, command: Command, listener: Listener) -> None:
        """Ask the origin, which answers to the page itself."""
        self._check_there()
        await self._passed_on.ask(next(self._numbers), self._arrive(listener), command, listener)

    def _check_there(self) -> None:
        """Pass if the origin is there, or went only just now.

        Raises:
            OriginAwayError: It is away.
        """
        if not self.is_there and self._loop.time() - self.away_since_s > PATIENCE_S:
            raise OriginAwayError

    # Joining and downloads

    async def _join(self, name: str, code: str, password: str, ticket: str) -> Joined:
        if not self.is_there:
            raise NotJoiningError("away", "The studio is away: try again in a moment.")
        number = next(self._numbers)
        before = ticket if len(ticket) <= TICKET_LETTERS_MAX else ""
        form = AskJoin(number, name[:400], code[:64], password[:400], before)
        if self._joining.is_full:
            raise NotJoiningError("tries", "Too many join at once: try again in a moment.")
        try:
            return await self._joining.ask(number, form)
        except OriginAwayError as error:
            raise NotJoiningError("away", str(error)) from None

    async def knows(self, code: str) -> bool:
        """Return whether this is the code of the class: it is told before what else is missing."""
        try:
            return (await self._join("", code, "", "")).why not in _NOT_KNOWN
        except NotJoiningError:
            return False

    async def download(
        self, document: str, what: str, options: Sequence[tuple[str, str]]
    ) -> Download:
        """Return a document for other programs, made by the origin.

        Raises:
            StudioError: It cannot be made, or the origin is away.
        """
        if not self.is_there:
            raise OriginAwayError
        if self._downloading.is_full or len(document) > NAME_LETTERS_MAX:
            raise CommandError("Too much is asked for here at once: try again in a moment.")
        number = next(self._numbers)
        ticket = self._ticket_for(document) or next((one.ticket for one in self._members()), "")
        asked = AskDownload(number, ticket, document, what, tuple(options))
        found = await self._downloading.ask(number, asked)
        if found.kind:
            raise CommandError(found.reason)
        # It goes into a header: another would be one more header to the browser.
        media_type = found.media_type if found.media_type in _MEDIA_TYPES else _ANY_BYTES
        return Download(found.name, media_type, (found.data,))

    def _ticket_of(self, lane: DataLaneEnd) -> str:
        """Return the ticket of a data lane's person."""
        member = self.classroom.person(lane.person) if isinstance(lane, DataLane) else None
        return member.ticket if member else ""

    def _ticket_for(self, document: str) -> str:
        """Return the ticket of whose copy a document is, or of a helper; empty where all may."""
        owner = owner_of(document)
        if not owner:
            return ""
        member = self.classroom.person(owner)
        if member is not None and self.classroom.admits(member):
            return member.ticket
        members = self._members()
        return next((one.ticket for one in members if one.role.includes(Role.HELPER)), "")

    def _members(self) -> Iterator[RelayedMember]:
        """Give the people who have pages open here, and may."""
        for person in {one.person for one in self._pages}:
            member = self.classroom.person(person)
            if member is not None and self.classroom.admits(member):
                yield member

    # What the server's routes use of an engine

    @property
    def default_document(self) -> str | None:
        """Id of the document that `/` leads to."""
        return (self.classroom.state.default_document or None) if self.classroom.state else None

    @property
    def documents(self) -> Mapping[str, RoomDocument]:
        """Every open document by its id."""
        known = self.classroom.state.documents if self.classroom.state else ()
        return {one: RoomDocument(self, one) for one in known}

    @property
    def bags_folder(self) -> Path:
        """Where nothing is."""
        return _NOWHERE

    def is_writing(self, folder: Path) -> bool:
        """Return that no bag is written here."""
        del folder
        return False

    def document(self, name: str) -> RoomDocument:
        """Return one document.

        Raises:
            UnknownDocumentError: No open document has that id.
        """
        self.check(name)
        return RoomDocument(self, name)

    def check(self, name: str) -> None:
        """Pass if there may be a document of that id: of a copy only the origin knows.

        Raises:
            UnknownDocumentError: There is none.
        """
        state = self.classroom.state
        is_known = owner_of(name) or (state is not None and name in state.documents)
        if not is_known or len(name) > NAME_LETTERS_MAX:
            raise UnknownDocumentError(name)

    async def ready(self, name: str) -> RoomDocument:
        """Return one document, as `document`."""
        return self.document(name)

    # Time

    def _now_ns(self) -> int:
        return int(self._loop.time() * 1e9)

    async def _tick(self) -> None:
        while True:
            await asyncio.sleep(_TICK_S)
            self.lanes.close_idle()
            self.scenes.close_idle()
            if self._line and not self._greeted and self._loop.time() > self._greet_by_s:
                self.hang_up()
            if self.is_there:
                self._send(Ping(self._now_ns()))
                self._tell_viewers()
            elif self._loop.time() - self.away_since_s > _GIVE_UP_S:
                self._passed_on.refuse_all(OriginAwayError())
                self.lanes.give_up(str(OriginAwayError()))

    def _tell_viewers(self) -> None:
        pages = self.lanes.studio.listeners
        guests = sum(one.person.startswith(VIEWER) for one in pages)
        viewers = Viewers(len(pages), guests)
        if viewers != self._sent_viewers:
            self._sent_viewers = viewers
            self._send(viewers)


_JOINING_MAX, _DOWNLOADING_MAX = 200, 8  # ask the origin at once
_NOT_KNOWN: Final = frozenset({"code", "closed", "tries", "away"})
_NOWHERE: Final = Path("/nonexistent")
