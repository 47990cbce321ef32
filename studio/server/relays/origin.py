"""The Origin: the studio's room as its relays see it, and the lines to all of them."""

from __future__ import annotations

import asyncio
import hmac
import secrets
from functools import cached_property
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError, NotJoiningError, StudioError, TicketError
from studio.protocol.relays import Relays, RelayView
from studio.protocol.roles import Role, Visitor
from studio.server.joining import Rate, Tries
from studio.server.relays.keys import parse_relay_line
from studio.server.relays.messages import VIEWER, RoomState
from studio.server.relays.origin_end import OriginEnd
from studio.server.relays.origin_topics import allowed_topics
from studio.server.relays.relayed_class import link_digest
from studio.server.relays.tickets import RoomIdentity, TicketIssuer, read_ticket

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.classroom.classroom import Classroom
    from studio.protocol.roles import Person
    from studio.server.relays.keys import RelayAddress
    from studio.server.relays.line import Line
    from studio.server.relays.messages import AskJoin
    from studio.server.relays.origin_end import SharedStudio
    from studio.server.relays.uplink import Uplink

RELAYS_MAX: Final = 16
_SEEN_EVERY_S: Final = 1.0
_GUESSES: Final = Rate(300.0, 3.0), Rate(600.0, 6.0)
"""Wrong codes of a relay, which holds each address to fewer, and of all relays."""
_JOINS: Final = Rate(2_000.0, 50.0), Rate(4_000.0, 100.0)


class Origin:
    """Used on the event loop only; built by who starts the server, with the class.

    Args:
        engine: The studio.
        classroom: Its class.
        session: Of this run of the studio.
        topics: Patterns of the topics that relays may pass on; none: all that a guest sees.
        joined: Called with the room's address at each relay, once it serves it.

    Attributes:
        uplinks: By the endpoints of the relays.
    """

    def __init__(
        self,
        engine: SharedStudio,
        classroom: Classroom,
        session: str,
        topics: Sequence[str] = (),
        joined: Callable[[str], object] = lambda _: None,
    ) -> None:
        self._engine, self._classroom, self._session = engine, classroom, session
        self._allows = allowed_topics(topics)
        self._joined, self._told = joined, set[str]()
        self.uplinks: dict[str, Uplink] = {}
        self._issuer: tuple[bytes, TicketIssuer] | None = None
        self._tries, self._joins = Tries(*_GUESSES), Tries(*_JOINS)
        self._shown: Relays | None = None
        self._watching: asyncio.Task[None] | None = None
        self._changing = asyncio.Lock()
        """Two that dial one relay at once would claim the room against each other."""
        classroom.relays = self

    # Relays

    async def begin(self, lines: Sequence[str], warn: Callable[[str], object]) -> None:
        """Dial the relays that were named, and those of before; what cannot be is told."""
        for line in lines:
            try:
                relay = await self.dial(line)
                if any(_is_at(one, relay.endpoint) for one in self._classroom.relay_lines):
                    await self._keep(relay.endpoint, relay.line)  # it may have another key now
            except StudioError as error:
                warn(str(error))
        for line in tuple(self._classroom.relay_lines):
            if not any(_is_at(line, one) for one in self.uplinks):
                try:
                    await self.dial(line)
                except StudioError as error:
                    warn(str(error))

    async def add(self, line: str) -> None:
        """Share the class by one relay more, also after the studio was started anew.

        Raises:
            RelayKeyError: It is no line of a relay.
            CommandError: There are as many as can be.
        """
        relay = await self.dial(line)
        await self._keep(relay.endpoint, relay.line)

    async def dial(self, line: str) -> RelayAddress:
        """Share the class by one relay more, from now on.

        Raises:
            RelayKeyError: It is no line of a relay.
            CommandError: There are as many as can be.
        """
        from studio.server.relays.uplink import Uplink  # noqa: PLC0415 - it imports Zenoh

        relay = parse_relay_line(line)
        if relay.endpoint not in self.uplinks and len(self.uplinks) >= RELAYS_MAX:
            raise CommandError(f"{RELAYS_MAX} relays are in use: remove one first.")
        async with self._changing:
            await self._drop(relay.endpoint)
            self.uplinks[relay.endpoint] = Uplink(
                relay, lambda: self.identity, self._session, self._end_of, self._changed
            )
        if self._watching is None:
            self._watching = asyncio.create_task(self._watch())
        self._changed()
        return relay

    async def remove(self, endpoint: str) -> None:
        """Share the class by this relay no more.

        Raises:
            CommandError: It is none of those in use.
        """
        async with self._changing:
            was_there = await self._drop(endpoint)
        if not was_there:
            raise CommandError(f"{endpoint} is no relay of this studio.")
        self._changed()
        await self._keep(endpoint)

    async def _keep(self, endpoint: str, line: str = "") -> None:
        """Keep this line of a relay in the place of the one before; empty: none."""
        kept = self._classroom.relay_lines
        kept[:] = [one for one in kept if not _is_at(one, endpoint)]
        if line:
            kept.append(line)
        await self._classroom.keep()

    async def close(self) -> None:
        """End all lines."""
        if self._watching is not None:
            self._watching.cancel()
        await asyncio.gather(*(self._drop(one) for one in tuple(self.uplinks)))

    def addresses(self) -> tuple[str, ...]:
        """Return where people type the code, of relays that are there."""
        return tuple(map(door_of, self.rooms()))

    def rooms(self) -> tuple[str, ...]:
        """Return the addresses of the class's page at relays that are there."""
        return tuple(one.address for one in self.uplinks.values() if one.state == "there")

    def guests(self) -> int:
        """Return how many pages of people outside of the class are open at relays."""
        return sum(one.end.guests for one in self.uplinks.values() if one.end)

    def event(self) -> Relays:
        """Return the relays, for presenters."""
        return Relays(relays=tuple(map(_view, self.uplinks.values())))

    def end_person(self, person: str) -> None:
        """End a person's pages at all relays."""
        for one in self.uplinks.values():
            if one.end:
                one.end.end_person(person)

    async def _drop(self, endpoint: str) -> bool:
        uplink = self.uplinks.pop(endpoint, None)
        if uplink is None:
            return False
        await uplink.close()
        return True

    def _end_of(self, line: Line, uplink: Uplink) -> OriginEnd:
        return OriginEnd(
            self._engine,
            self,
            line,
            relay=uplink.relay.endpoint,
            hang_up=lambda reason: uplink.hang_up(reason, refused=bool(reason)),
            allows=self._allows,
        )

    def _changed(self) -> None:
        self._shown = self.event()
        for address in self.rooms():
            if address not in self._told:
                self._told.add(address)
                self._joined(address)
        self._classroom.relays_changed()
        for one in self.uplinks.values():
            if one.end:
                one.end.tell_state()

    async def _watch(self) -> None:
        """Show presenters how many people there are, and which relay is behind."""
        while True:
            await asyncio.sleep(_SEEN_EVERY_S)
            if self.event() != self._shown:
                self._changed()

    # The room, for the lines

    @cached_property
    def identity(self) -> RoomIdentity:
        """Of the room; the same after a restart."""
        return RoomIdentity(bytes.fromhex(self._classroom.room_seed))

    @property
    def issuer(self) -> TicketIssuer:
        """Of tickets, which are no longer valid once the class has another key."""
        key = self._classroom.members.key
        if self._issuer is None or self._issuer[0] != key:
            seed = hmac.digest(key, b"tickets of relays", "sha256")
            self._issuer = key, TicketIssuer(seed, self.identity.id)
        return self._issuer[1]

    def state(self, relay: str) -> RoomState:
        """Return what a relay must know of the room."""
        classroom, engine = self._classroom, self._engine
        admission, control = classroom.admission, classroom.control
        others = (one for one in self.uplinks.values() if one.relay.endpoint != relay)
        return RoomState(
            session=self._session,
            tickets=self.issuer.public,
            link=link_digest(admission.link),
            is_open=admission.open,
            has_password=bool(admission.password),
            default_document=engine.default_document or "",
            documents=tuple(engine.documents),
            shown=control.shown,
            holder=control.holder,
            controlled=control.document,
            others=tuple(one.address for one in others if one.state == "there"),
            sent_out=tuple(one.person for one in classroom.members if one.removed),
        )

    def person(self, ticket: str) -> Person:
        """Return whose ticket it is.

        Raises:
            TicketError: It is nobody's, the class is closed, or they were sent out.
        """
        issuer, classroom = self.issuer, self._classroom
        found = read_ticket(ticket, issuer.public, self.identity.id)
        if not classroom.admission.open:
            raise TicketError("the class is closed.")
        if found.person.startswith(VIEWER):
            return Visitor(Role.GUEST, found.person, classroom.control)
        member = classroom.members.find(found.person)
        if member is None or member.removed:
            raise TicketError("they are not in the class.")
        return member

    @property
    def shown(self) -> str:
        """The copy that everybody may see; empty: none."""
        return self._classroom.control.shown

    def tickets(self) -> bytes:
        """Return the public key of those who sign tickets."""
        return self.issuer.public

    def has(self, person: Person) -> bool:
        """Whether a person may still be here."""
        classroom = self._classroom
        if not classroom.admission.open:
            return False
        if person.person.startswith(VIEWER):
            return True
        member = classroom.members.find(person.person)
        return member is not None and member is person and not member.removed

    async def join(self, relay: str, form: AskJoin) -> str:
        """Add a person, and return their ticket; one more than the class takes only looks.

        Raises:
            NotJoiningError: They may not join.
        """
        classroom = self._classroom
        admission = classroom.admission
        # Nobody guesses the link: who has it joins though others spend all tries.
        is_guess = bool(admission.password) or not admission.knows_link(form.code)
        if is_guess:
            self._tries.begin(relay)
        self._joins.begin(relay)
        try:
            member = await classroom.join(
                form.name, form.code, form.password, self._cookie_of(form.ticket)
            )
        except NotJoiningError as refusal:
            self._joins.give_back(relay)
            if is_guess and refusal.why not in {"code", "password"}:
                self._tries.give_back(relay)
            if refusal.why != "full":
                raise
            person = f"{VIEWER}{secrets.token_hex(8)}"
            return self.issuer.issue(person, form.name[:40], Role.GUEST.value)
        if is_guess:
            self._tries.give_back(relay)
        return self.issuer.issue(member.person, member.name, member.role.value)

    def _cookie_of(self, ticket: str) -> str:
        """Return the cookie that somebody with a ticket would have at the studio itself."""
        try:
            person = read_ticket(ticket, self.issuer.public, self.identity.id).person
        except TicketError:
            return ""
        member = self._classroom.members.find(person)
        return self._classroom.members.cookie_of(member) if member else ""


def door_of(room: str) -> str:
    """Return the address of a relay's own page, by that of a room there."""
    return room.rstrip("/").rpartition("/")[0] + "/"


def _is_at(line: str, endpoint: str) -> bool:
    return line.partition("#")[0] == endpoint


def _view(uplink: Uplink) -> RelayView:
    line, end = uplink.line, uplink.end
    return RelayView(
        endpoint=uplink.relay.endpoint,
        state=uplink.state,
        reason=uplink.reason,
        address=uplink.address,
        people=end.people() if end else 0,
        lag_ms=round(line.lag_s * 1000, -2) if line else 0.0,
    )
