"""The people of a class, by the id that is in their browser's cookie."""

from __future__ import annotations

import hmac
import math
import secrets
import time
from typing import TYPE_CHECKING, Final

from studio.errors import CommandError
from studio.protocol.classroom import NAME_MAX, MemberView
from studio.protocol.roles import Role, owner_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.classroom.record import MemberRecord
    from studio.protocol.roles import HasControl

MEMBERS_MAX: Final = 500
"""People of one class; one machine serves some three hundred."""


class Member:
    """One person: the same object for all their pages, so that what changes counts for each."""

    def __init__(self, person: str, name: str, role: Role, control: HasControl) -> None:
        self.person, self.name, self.role = person, name, role
        self.removed = False
        self.asks_s: float | None = None
        """Since when they ask for control, in seconds since the epoch."""
        self.hand_s: float | None = None
        self.ticks: dict[str, float] = {}
        """When steps of lessons were done, in seconds since the epoch, by `lesson/step`."""
        self._control = control

    def controls(self, document: str) -> bool:
        """Whether they have control: of a copy of their own, or of all that is shared."""
        if self.removed:
            return False
        if owner := owner_of(document):
            return owner == self.person
        holds = self._control.holder == self.person
        return holds and document in {"", self._control.document}

    def sees(self, document: str) -> bool:
        """Whether they may look at a document."""
        owner = owner_of(document)
        if owner in {"", self.person} or self.role.includes(Role.HELPER):
            return True
        return self._control.shown == document

    def view(self, *, here: bool, follows: bool) -> MemberView:
        """Return the member as presenters see them."""
        return MemberView(
            person=self.person,
            name=self.name,
            role=self.role.value,  # type: ignore[arg-type]
            here=here,
            follows=follows,
            removed=self.removed,
            asks_s=self.asks_s,
            hand_s=self.hand_s,
        )


class Members:
    """Everybody who has joined, and the proofs in their cookies.

    Args:
        key: Signs the cookies; with another one everybody has to join again.
        control: Who has control.
    """

    def __init__(self, key: bytes, control: HasControl) -> None:
        self.key = key
        self._control = control
        self._by_person: dict[str, Member] = {}

    def __iter__(self) -> Iterator[Member]:
        return iter(self._by_person.values())

    def __len__(self) -> int:
        return len(self._by_person)

    def find(self, person: str) -> Member | None:
        """Return the member of that id."""
        return self._by_person.get(person)

    def get(self, person: str) -> Member:
        """Return the member of that id.

        Raises:
            CommandError: There is none.
        """
        if (member := self._by_person.get(person)) is None:
            raise CommandError("This person is not in the class any more.")
        return member

    def add(self, name: str, role: Role) -> Member:
        """Add a person under a name that nobody else has."""
        member = Member(secrets.token_hex(8), self.free_name(name), role, self._control)
        self._by_person[member.person] = member
        return member

    def restore(self, records: Iterable[MemberRecord]) -> None:
        """Take back the people of an earlier run."""
        for one in records:
            member = Member(one.person, one.name, Role(one.role), self._control)
            member.removed = one.removed
            member.ticks = dict(one.ticks)
            self._by_person[one.person] = member

    def drop(self, member: Member) -> None:
        """Forget a person."""
        self._by_person.pop(member.person, None)

    def clear(self) -> None:
        """Forget everybody; no cookie of before is valid any more."""
        self._by_person.clear()
        self.renew_key()

    def renew_key(self) -> None:
        """Make the cookies of all invalid; nobody is forgotten."""
        self.key = secrets.token_bytes(32)

    def free_name(self, wanted: str, own: str = "") -> str:
        """Return the name as it can be shown; with a number if another person has it.

        Args:
            wanted: As it was typed.
            own: The person whose name it is to be, who may keep the one they have.

        Raises:
            CommandError: Nothing of it can be shown.
        """
        name = readable(wanted)
        if not name:
            raise CommandError("A name needs letters: type another one.")
        taken = {one.name.casefold() for one in self if one.person != own}
        names = (name, *(f"{name} {number}" for number in range(2, MEMBERS_MAX + 2)))
        return next(one for one in names if one.casefold() not in taken)

    def cookie_of(self, member: Member) -> str:
        """Return the value of the cookie by which a browser is this person again."""
        return f"{member.person}.{self._proof(member.person)}"

    def of_cookie(self, given: str) -> Member | None:
        """Return whose cookie this is; None if it is nobody's, or theirs who was sent out."""
        member = self.any_of_cookie(given)
        return None if member is None or member.removed else member

    def any_of_cookie(self, given: str) -> Member | None:
        """Return whose cookie this is, also of somebody who was sent out."""
        person, _, proof = given.partition(".")
        is_valid = hmac.compare_digest(proof.encode(), self._proof(person).encode())
        return self._by_person.get(person) if is_valid else None

    def _proof(self, person: str) -> str:
        return hmac.new(self.key, f"member {person}".encode(), "sha256").hexdigest()


def readable(text: str) -> str:
    """Return a name without what cannot be seen, blanks run together, cut to its limit."""
    shown = "".join(one if one.isprintable() else " " for one in text)
    return " ".join(shown.split())[:NAME_MAX].strip()


def now_s(*after: float | None) -> float:
    """Return the seconds since the epoch; later than `after`, though the clock was set back."""
    later = [math.nextafter(one, math.inf) for one in after if one is not None]
    return max([time.time_ns() / 1e9, *later])
