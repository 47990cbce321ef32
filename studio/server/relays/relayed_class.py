"""The class as a relay knows it: people by their tickets, and the form to join passed on."""

from __future__ import annotations

import hashlib
import hmac
from collections import OrderedDict
from contextlib import suppress
from typing import TYPE_CHECKING, Final

from studio.errors import NotJoiningError, TicketError
from studio.protocol.classroom import You
from studio.protocol.roles import Role, owner_of
from studio.server.relays.tickets import read_ticket

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from studio.protocol.roles import Person
    from studio.server.relays.messages import Joined, RoomState

_PEOPLE_MAX: Final = 50_000


class RelayedMember:
    """One person at this relay, as their ticket says; the same object for all their pages."""

    def __init__(self, room: RelayedClass, person: str, name: str, role: Role) -> None:
        self._room = room
        self.person, self.name, self.role = person, name, role
        self.ticket = ""

    def is_of(self, room: RelayedClass) -> bool:
        """Whether they came by a ticket of this room; another room may know them by the same id."""
        return self._room is room

    def controls(self, document: str) -> bool:
        """Whether they have control, as far as the relay was told: the origin asks again."""
        if owner := owner_of(document):
            return owner == self.person
        state = self._room.state
        if state is None or state.holder != self.person:
            return False
        return not document or state.controlled == document

    def sees(self, document: str) -> bool:
        """Whether they may look at a document."""
        owner = owner_of(document)
        if owner in {"", self.person} or self.role.includes(Role.HELPER):
            return True
        return self._room.state is not None and self._room.state.shown == document


class RelayedControl:
    """Who has control, as the origin said."""

    def __init__(self, room: RelayedClass) -> None:
        self._room = room

    @property
    def holder(self) -> str:
        """The person who has it."""
        return self._room.state.holder if self._room.state else ""

    @property
    def document(self) -> str:
        """The shared document that the holder has control of."""
        return self._room.state.controlled if self._room.state else ""

    @property
    def shown(self) -> str:
        """The copy that everybody may see."""
        return self._room.state.shown if self._room.state else ""


class RelayedAdmission:
    """What somebody has to know to join, which only the origin knows."""

    def __init__(self, room: RelayedClass) -> None:
        self._room = room

    @property
    def open(self) -> bool:
        """Whether others may join."""
        return self._room.state is not None and self._room.state.is_open

    @property
    def password(self) -> str:
        """Not empty where one is asked for."""
        return "?" if self._room.state and self._room.state.has_password else ""

    def knows_link(self, given: str) -> bool:
        """Whether this is the code of the link, which nobody guesses."""
        state = self._room.state
        return state is not None and hmac.compare_digest(state.link, link_digest(given))


def link_digest(code: str) -> bytes:
    """Return the digest of a link's code, by which a relay knows who has the link."""
    return hashlib.blake2b(code.encode(), digest_size=16).digest()


class RelayedClass:
    """Takes the place of the classroom behind the routes of the server.

    Args:
        room: The room's name.
        ask_join: Passes the form on to the origin: name, code, password, and the ticket of before.
    """

    def __init__(
        self, room: str, ask_join: Callable[[str, str, str, str], Awaitable[Joined]]
    ) -> None:
        self._name, self._ask_join = room, ask_join
        self.state: RoomState | None = None
        self.control, self.admission = RelayedControl(self), RelayedAdmission(self)
        self._people: OrderedDict[str, RelayedMember] = OrderedDict()
        self._by_ticket: dict[str, RelayedMember] = {}

    def member_of_cookie(self, given: str) -> RelayedMember | None:
        """Return whose ticket this is; nobody's while the class is closed."""
        if self.state is None or not self.state.is_open:
            return None
        member = self._member(given)
        return member if member is not None and self.admits(member) else None

    def admits(self, member: RelayedMember) -> bool:
        """Whether they may be here, by what the origin said last."""
        state = self.state
        if state is None or not state.is_open or member.person in state.sent_out:
            return False
        return self._people.get(member.person) is member

    def is_person(self, person: str, visitor: Person) -> bool:
        """Whether somebody is this person of this class; another's may have the same id."""
        return visitor.person == person and self.is_here(visitor)

    def is_here(self, visitor: Person) -> bool:
        """Whether somebody is of this class."""
        return isinstance(visitor, RelayedMember) and visitor.is_of(self)

    def is_out(self, visitor: Person) -> bool:
        """Whether somebody is of this class, and may not be here any more."""
        known = visitor if isinstance(visitor, RelayedMember) else None
        return known is not None and known.is_of(self) and not self.admits(known)

    def is_sent_out(self, given: str) -> bool:
        """Whether this is the ticket of somebody who was sent out."""
        member, state = self._member(given), self.state
        return member is not None and state is not None and member.person in state.sent_out

    async def join(self, name: str, code: str, password: str, cookie: str) -> RelayedMember:
        """Add a person, whom the origin lets in.

        Raises:
            NotJoiningError: They may not join, or the origin is away.
        """
        joined = await self._ask_join(name, code, password, cookie)
        if joined.why:
            raise NotJoiningError(joined.why, joined.reason)
        member = self._member(joined.ticket)
        if member is None:
            raise NotJoiningError("closed", "The studio's ticket is not valid here: try again.")
        return member

    def cookie_of(self, person: Person) -> str:
        """Return the ticket by which a browser is this person again."""
        known = self._people.get(person.person)
        return known.ticket if known else ""

    def person(self, person: str) -> RelayedMember | None:
        """Return a person who came here."""
        return self._people.get(person)

    async def log_out(self) -> None:
        """Nobody may ask a relay for it."""

    def note(self, you: bytes) -> None:
        """Take what the origin says to a person of themselves."""
        with suppress(ValueError):
            event = You.model_validate_json(you)
            member = self._people.get(event.person)
            if member is not None and event.role != Role.PRESENTER.value:
                member.role, member.name = Role(event.role), event.name

    def renew(self, state: RoomState) -> None:
        """Take what the origin says of the room."""
        if self.state is not None and self.state.tickets != state.tickets:
            self._people.clear()
            self._by_ticket.clear()
        self.state = state

    def _member(self, ticket: str) -> RelayedMember | None:
        state = self.state
        if state is None or not ticket:
            return None
        if known := self._by_ticket.get(ticket):
            return known
        try:
            found = read_ticket(ticket, state.tickets, self._name)
            role = Role(found.role)
        except (TicketError, ValueError):
            return None
        if role is Role.PRESENTER:
            return None
        member = self._people.pop(found.person, None)
        if member is None:
            member = RelayedMember(self, found.person, found.name, role)
        self._by_ticket.pop(member.ticket, None)
        member.ticket = ticket
        self._people[found.person] = self._by_ticket[ticket] = member
        if len(self._people) > _PEOPLE_MAX:
            _, forgotten = self._people.popitem(last=False)
            self._by_ticket.pop(forgotten.ticket, None)
        return member
