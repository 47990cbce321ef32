"""The class of a studio: its people, how others join, who has control, and what each is sent."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Final

from studio.classroom.admission import Admission
from studio.classroom.control import Control, Robot
from studio.classroom.following import Following, Seen
from studio.classroom.members import MEMBERS_MAX, Members, now_s
from studio.classroom.nodes.nodes import COMMANDS as NODE_COMMANDS
from studio.classroom.nodes.nodes import StudentNodes
from studio.classroom.qr_code import qr_svg
from studio.classroom.reach import Reach
from studio.classroom.record import ClassFile, ClassRecord, MemberRecord
from studio.classroom.relays import COMMANDS as RELAY_COMMANDS
from studio.classroom.relays import NoRelays, Relays
from studio.debounce import Throttle
from studio.errors import CommandError, DataFolderError, NotJoiningError
from studio.protocol.classroom import (
    AskControl,
    ClassState,
    EndClass,
    Focus,
    Follow,
    GatherAll,
    GiveControl,
    Lead,
    LowerHand,
    PauseClass,
    RaiseHand,
    ReadmitMember,
    RemoveMember,
    RenewCode,
    ReturnControl,
    SetClass,
    SetMemberRole,
    SetName,
    ShowFocus,
    ShowView,
    StartClass,
    Stopped,
    StopRobot,
    TakeControl,
    You,
)
from studio.protocol.classroom import Control as ControlEvent
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.listeners import Audience, encode, send
from studio.protocol.roles import RELAY, Role, original_of

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable
    from pathlib import Path

    from studio.classroom.members import Member
    from studio.protocol.listeners import Listener
    from studio.protocol.roles import Person

_SOON_S: Final = 0.05
_PAUSE_S: Final = 0.25
"""Between two lists of the class: hundreds may join at once."""
_log = logging.getLogger(__name__)


class Classroom:
    """Used on the event loop only.

    Args:
        file: Where it is kept; None: nowhere.
        reach: Where others find it.
    """

    def __init__(self, file: Path | None = None, reach: Reach | None = None) -> None:
        self.reach = reach or Reach()
        self._file = ClassFile(file)
        self.folder = None if file is None else file.with_suffix("")
        """Where others may keep what is deleted with the class."""
        kept = self._file.read()
        self.control = Control(self._control_changed)
        self.members = Members(bytes.fromhex(kept.key), self.control)
        self.members.restore(kept.members)
        self._own_ticks = dict(kept.ticks)
        """What the presenter has done of lessons."""
        self.admission = Admission(kept)
        self.admission.open = kept.open and not self.reach.why_not
        self.robot: Robot | None = None
        self.relays: Relays = NoRelays()
        self.on_control: Callable[[str], object] | None = None
        """Called with the document that a member has control of now."""
        self.on_end: Callable[[], Awaitable[None]] | None = None
        """Deletes what others keep of the class."""
        self.end_pages: Callable[[str], object] = lambda person: None
        """Ends all connections of a person."""
        self.room_seed = kept.room
        self.relay_lines = list(kept.relays)
        """Of the relays that a presenter added."""
        self._pages: dict[str, set[Listener]] = {}
        self._everybody = Audience()
        self.following = Following()
        self.nodes = StudentNodes(
            self.reach.listen, self.reach.host, kept.nodes, self._keep_quietly, self._everybody.send
        )
        self._leaders_later = Throttle(self._send_to_leaders, first_s=_SOON_S, pause_s=_PAUSE_S)

    async def close(self) -> None:
        """Wait for nobody any more."""
        self.control.close()
        await self.nodes.close()
        await self._leaders_later.close()

    # Joining

    def member_of_cookie(self, given: str) -> Member | None:
        """Return who comes with this cookie, while the class is open to them."""
        return self.members.of_cookie(given) if self.admission.open else None

    def is_sent_out(self, given: str) -> bool:
        """Whether this is the cookie of somebody who was sent out."""
        member = self.members.any_of_cookie(given)
        return member is not None and member.removed

    async def join(self, name: str, code: str, password: str, cookie: str) -> Member:
        """Add a person.

        Args:
            name: As typed.
            code: The six letters as typed, or the code of the link.
            password: As typed.
            cookie: What the browser has of before; somebody who was sent out is known by it.

        Raises:
            NotJoiningError: They may not join.
        """
        before = self.members.any_of_cookie(cookie)
        if before is not None and before.removed:
            raise NotJoiningError("removed", "You were sent out of this class: ask to be let in.")
        admission = self.admission
        admission.check_code(code)
        await admission.check_password(password)
        self.admission.check_code(code)  # the class may have ended meanwhile
        if before is not None:
            return before
        try:
            member = self._add(name)
        except CommandError as error:
            raise NotJoiningError("name", str(error)) from error
        await self._keep_quietly()
        self._changed()
        return member

    def cookie_of(self, person: Person) -> str:
        """Return the value of the cookie by which a browser is this member again."""
        return self.members.cookie_of(self.members.get(person.person))

    def _add(self, name: str) -> Member:
        if len(self.members) >= MEMBERS_MAX:
            gone = next(filter(self._may_be_dropped, self.members), None)
            if gone is None:
                raise NotJoiningError("full", f"The class is full: {MEMBERS_MAX} people are here.")
            self.members.drop(gone)
            self.end_pages(gone.person)
        return self.members.add(name, Role(self.admission.join_as))

    def _may_be_dropped(self, one: Member) -> bool:
        """Whether a place may be taken: who was sent out, or helps, is always known again.

        The nodes of who has closed the page may still run.
        """
        is_known = one.removed or one.role is Role.HELPER or self.nodes.has_access(one.person)
        return not (is_known or self.is_here(one.person))

    # Pages that come and go

    def attach(self, listener: Listener) -> None:
        """Send a new page who it is and who has control, and every change from then on.

        A relay is sent the same, but is nobody: who has a page there arrives by itself.
        """
        self._everybody.add(listener)
        send(listener, self._control_event())
        if listener.person != RELAY:
            self.arrive(listener)
        self.following.attach(listener)
        send(listener, self.nodes.event())

    def arrive(self, listener: Listener) -> None:
        """Send a new page who it is, and what concerns its person from then on."""
        person = listener.person
        self._pages.setdefault(person, set()).add(listener)
        self.control.back(person)
        send(listener, self._you(person, listener.role))
        if listener.role.includes(Role.HELPER):
            send(listener, self._state())
        if listener.role is Role.PRESENTER:
            send(listener, self.relays.event())
        self._changed()

    def relays_changed(self) -> None:
        """Show presenters the relays, and where people join now."""
        for page in self._leaders():
            if page.role is Role.PRESENTER:
                page.post(encode(self.relays.event()), key="relays")
        self._changed()

    def detach(self, listener: Listener) -> None:
        """Remove a page; it need not be there."""
        self._everybody.remove(listener)
        self.following.detach(listener)
        person = listener.person
        pages = self._pages.get(person, set())
        if listener not in pages:
            return
        pages.remove(listener)
        if not pages:
            del self._pages[person]
            self.control.left(person, may_move=bool(self.relays.addresses()))
        self._changed()

    def is_here(self, person: str) -> bool:
        """Whether a person has a page open."""
        return person in self._pages

    # The class as a whole

    async def start(self) -> None:
        """Let others join.

        Raises:
            CommandError: This studio may not be shared.
        """
        if self.reach.why_not:
            raise CommandError(self.reach.why_not)
        self.admission.open = True
        await self.keep()
        self._all_changed()

    async def pause(self) -> None:
        """Let nobody in for a while; those who are here are sent away."""
        self.admission.open = False
        self.control.give("")
        self._all_changed()
        self._end_all_pages()
        await self.keep()

    async def end(self) -> None:
        """End the class, and delete all that is kept of it."""
        self.admission = Admission(ClassRecord())
        self.control.give("")
        people = [one.person for one in self.members]
        self.members.clear()
        self._all_changed()
        for person in people:
            self.end_pages(person)
        await self.nodes.stop()
        await self._file.delete()
        if self.relay_lines:  # which are about nobody
            await self._keep_quietly()
        if self.on_end is not None:
            await self.on_end()

    async def set(self, command: SetClass) -> None:
        """Change how others join."""
        admission = self.admission
        if command.locked is not None:
            admission.locked = command.locked
        if command.join_as is not None:
            admission.join_as = command.join_as
        if command.password is not None:
            await admission.set_password(command.password)
        await self.keep()
        self._changed()

    async def renew_code(self) -> None:
        """Make another code and link."""
        self.admission.renew()
        await self.keep()
        self._changed()

    async def log_out(self) -> None:
        """Make all members' cookies invalid: each has to join again, and is another person then.

        What those of before have made is kept, under their names. Their own nodes cannot join any
        more.
        """
        await self.nodes.stop()
        self.members.renew_key()
        self.control.give("")
        await self._keep_quietly()

    # People

    async def set_role(self, command: SetMemberRole) -> None:
        """Make a person something else; who only looks keeps no control."""
        member = self.members.get(command.person)
        member.role = Role(command.role)
        if member.role is Role.GUEST:
            member.asks_s = member.hand_s = None
            if self.control.holder == member.person:
                self.control.give("")
            await self.nodes.revoke(member.person)
        await self.keep()
        self._tell(member.person)

    async def remove(self, person: str) -> None:
        """Send a person out."""
        member = self.members.get(person)
        member.removed = True
        member.asks_s = member.hand_s = None
        if self.control.holder == person:
            self.control.give("")
        self._changed()
        self.end_pages(person)
        await self.keep()
        await self.nodes.revoke(person)

    async def readmit(self, person: str) -> None:
        """Let a person in again."""
        self.members.get(person).removed = False
        await self.keep()
        self._changed()

    async def rename(self, person: str, name: str) -> None:
        """Change one's own name."""
        member = self.members.get(person)
        member.name = self.members.free_name(name, own=person)
        await self.keep()
        self._tell(person)
        if self.control.holder == person:
            self._everybody.send(self._control_event())

    def raise_hand(self, person: str, *, raised: bool) -> None:
        """Raise a hand, or take it down."""
        member = self.members.get(person)
        if raised != (member.hand_s is not None):
            member.hand_s = now_s(*(one.hand_s for one in self.members)) if raised else None
            self._tell(person)

    def lower_hands(self, person: str) -> None:
        """Take down the hand of a person, or of everybody."""
        for one in (self.members.get(person),) if person else tuple(self.members):
            self.raise_hand(one.person, raised=False)

    def follow(self, listener: Listener, *, following: bool) -> None:
        """See what the presenter looks at, or no longer."""
        if self.following.follow(listener, following=following):
            self._changed()

    # Lessons

    def ticks_of(self, person: str, role: Role) -> dict[str, float] | None:
        """Return when steps of lessons were done, to be added to; None: nothing is kept of them."""
        if member := self.members.find(person):
            return member.ticks
        return self._own_ticks if role is Role.PRESENTER else None

    async def keep_ticks(self) -> None:
        """Keep what was done of lessons."""
        await self._keep_quietly()

    # Control

    def has_control(self, page: Listener) -> bool:
        """Whether the person of a page has control of the ROS system."""
        holder = self.control.holder
        return page.person == holder if holder else page.role is Role.PRESENTER

    def ask_control(self, person: str, *, asking: bool) -> None:
        """Ask for control, or no longer; who asked first is first in the list."""
        member = self.members.get(person)
        if self.control.holder == person or asking == (member.asks_s is not None):
            return
        member.asks_s = now_s(*(one.asks_s for one in self.members)) if asking else None
        self._tell(person)

    def give_control(self, person: str, document: str = "") -> None:
        """Give control of a document and of ROS to a person; empty: back to the presenter.

        Raises:
            CommandError: They are not here, or only look.
        """
        if person:
            member = self.members.get(person)
            if not self.is_here(person) or member.removed:
                raise CommandError(f"{member.name} is not here: wait until they are back.")
            if not member.role.includes(Role.STUDENT):
                raise CommandError(f"{member.name} only looks: make them a student first.")
            member.asks_s = None
        self.control.give(person, original_of(document))

    def take_control(self, asker: Listener, document: str = "") -> None:
        """Take control: for the presenter, or for a helper."""
        self.give_control("" if asker.role is Role.PRESENTER else asker.person, document)

    def return_control(self, person: str) -> None:
        """Give control back, if one has it."""
        if self.control.holder == person:
            self.control.give("")

    async def stop_robot(self, asker: Listener) -> None:
        """Stop all that pages make robots do, and tell everybody who did."""
        if self.robot is not None:
            await self.robot.stop()
        member = self.members.find(asker.person)
        self._everybody.send(Stopped(name=member.name if member else ""))

    def _control_changed(self, before: str) -> None:
        holder = self.control.holder
        if self.robot is not None:
            # All presenters are one; of a member who had it, only theirs ends.
            self.robot.release(lambda one: one == holder if holder else one != before)
        if self.on_control is not None and holder:
            self.on_control(self.control.document)
        self._everybody.send(self._control_event())
        for person in (before, self.control.holder):
            self._tell(person)

    # What is sent

    def _control_event(self) -> ControlEvent:
        holder = self.members.find(self.control.holder)
        return ControlEvent(
            class_open=self.admission.open,
            holder=self.control.holder,
            name=holder.name if holder else "",
            document=self.control.document if holder else "",
        )

    def _you(self, person: str, role: Role) -> You:
        member = self.members.find(person)
        has_control = member.controls("") if member else role is Role.PRESENTER
        return You(
            person=person,
            name=member.name if member else "",
            role=role.value,  # type: ignore[arg-type]
            has_control=has_control and (member is not None or not self.control.holder),
            asking=member is not None and member.asks_s is not None,
            hand=member is not None and member.hand_s is not None,
        )

    def _tell(self, person: str) -> None:
        """Send what changed about a person: to their own pages, and to those who lead."""
        if person:
            for page in tuple(self._pages.get(person, ())):
                send(page, self._you(person, page.role))
        else:
            for page in self._leaders():
                if page.role is Role.PRESENTER:
                    send(page, self._you(page.person, page.role))
        self._changed()

    def _all_changed(self) -> None:
        self._everybody.send(self._control_event())
        self._changed()

    def _changed(self) -> None:
        if self._leaders():
            self._leaders_later.trigger()

    def _leaders(self) -> list[Listener]:
        pages = (page for pages in tuple(self._pages.values()) for page in pages)
        return [page for page in pages if page.role.includes(Role.HELPER)]

    async def _send_to_leaders(self) -> None:
        data = encode(self._state())
        for page in self._leaders():
            page.post(data, key="class_state")

    @property
    def addresses(self) -> tuple[str, ...]:
        """Where others join: at relays first, which are reached from anywhere."""
        return (*self.relays.addresses(), *self.reach.addresses)

    @property
    def link(self) -> str:
        """The first page with the longer code in its address; empty: nobody is told of any."""
        addresses = (*self.relays.rooms(), *self.reach.addresses)
        return f"{addresses[0]}join?code={self.admission.link}" if addresses else ""

    def _state(self) -> ClassState:
        admission, reach, link = self.admission, self.reach, self.link
        return ClassState(
            open=admission.open,
            locked=admission.locked,
            has_password=bool(admission.password),
            join_as=admission.join_as,
            code=admission.code,
            addresses=self.addresses,
            link=link,
            qr=qr_svg(link) if link and admission.open else "",
            fingerprint=reach.fingerprint,
            only_here=reach.only_here and not self.relays.addresses(),
            viewers=self._viewers(),
            members=tuple(
                one.view(here=self.is_here(one.person), follows=self._follows(one.person))
                for one in self.members
            ),
        )

    def _viewers(self) -> int:
        pages = (page for one in self._pages.values() for page in one)
        here = sum(
            page.role is Role.GUEST and self.members.find(page.person) is None for page in pages
        )
        return here + self.relays.guests()

    def _follows(self, person: str) -> bool:
        return any(map(self.following.is_following, self._pages.get(person, ())))

    # Keeping

    def _record(self) -> ClassRecord:
        admission = self.admission
        return ClassRecord(
            open=admission.open,
            code=admission.code,
            link=admission.link,
            locked=admission.locked,
            password=admission.password,
            join_as=admission.join_as,
            key=self.members.key.hex(),
            room=self.room_seed,
            relays=tuple(self.relay_lines),
            nodes=self.nodes.record,
            ticks=self._own_ticks,
            members=tuple(
                MemberRecord.model_validate(one, from_attributes=True) for one in self.members
            ),
        )

    async def keep(self) -> None:
        """Keep what the class is.

        Raises:
            DataFolderError: The disk refuses it.
        """
        await self._file.keep(self._record)

    async def _keep_quietly(self) -> None:
        """Keep it; a full disk is not the fault of who joins."""
        try:
            await self.keep()
        except DataFolderError as error:
            _log.warning("%s", error)

    def _end_all_pages(self) -> None:
        for one in tuple(self.members):
            self.end_pages(one.person)


def _focus(shown: ShowFocus) -> Focus:
    return Focus(document=shown.document, part=shown.part, site=shown.site, panel=shown.panel)


_OFTEN: Final = Limits(bytes_max=1_000, per_second=5)

_VIEWS: Final = Limits(bytes_max=1_000, per_second=60)
_FOCUSES: Final = Limits(bytes_max=4_000, per_second=30)

COMMANDS: Final = Commands[Classroom](Scope.STUDIO)
COMMANDS.include(NODE_COMMANDS, lambda room, _: room.nodes)
COMMANDS.include(RELAY_COMMANDS, lambda room, _: room.relays)
COMMANDS.presenter(Lead, lambda room, c, _: room.following.lead(leading=c.leading))
COMMANDS.presenter(GatherAll, lambda room, _, __: room.following.gather())
COMMANDS.presenter(
    ShowView,
    lambda room, c, who: room.following.show_view(
        who, c.document, Seen(c.eye, c.target, c.pointer, c.up, c.flat, c.field)
    ),
    limits=_VIEWS,
)
COMMANDS.presenter(
    ShowFocus, lambda room, c, who: room.following.show_focus(who, _focus(c)), limits=_FOCUSES
)
COMMANDS.viewer(Follow, lambda room, c, who: room.follow(who, following=c.following), limits=_OFTEN)
COMMANDS.presenter(StartClass, lambda room, _, __: room.start())
COMMANDS.presenter(PauseClass, lambda room, _, __: room.pause())
COMMANDS.presenter(EndClass, lambda room, _, __: room.end())
COMMANDS.presenter(SetClass, lambda room, c, _: room.set(c))
COMMANDS.presenter(RenewCode, lambda room, _, __: room.renew_code())
COMMANDS.presenter(SetMemberRole, lambda room, c, _: room.set_role(c))
COMMANDS.presenter(RemoveMember, lambda room, c, _: room.remove(c.person))
COMMANDS.presenter(ReadmitMember, lambda room, c, _: room.readmit(c.person))
COMMANDS.helper(
    GiveControl, lambda room, c, _: room.give_control(c.person, c.document), limits=_OFTEN
)
COMMANDS.helper(TakeControl, lambda room, c, who: room.take_control(who, c.document), limits=_OFTEN)
COMMANDS.helper(LowerHand, lambda room, c, _: room.lower_hands(c.person), limits=_OFTEN)
COMMANDS.viewer(SetName, lambda room, c, who: room.rename(who.person, c.name), limits=_OFTEN)
COMMANDS.student(
    AskControl,
    lambda room, c, who: room.ask_control(who.person, asking=c.asking),
    limits=_OFTEN,
)
COMMANDS.student(ReturnControl, lambda room, _, who: room.return_control(who.person), limits=_OFTEN)
COMMANDS.student(
    RaiseHand, lambda room, c, who: room.raise_hand(who.person, raised=c.raised), limits=_OFTEN
)
COMMANDS.student(StopRobot, lambda room, _, who: room.stop_robot(who), limits=_OFTEN)
