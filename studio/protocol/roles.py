"""Roles and persons; what a role may do is in the commands' permissions."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final, Protocol


class Role(StrEnum):
    """What a person is here. Each role may what the ones below it may.

    A presenter owns the studio: files, the connection with ROS 2, sharing. A helper gives control
    to others and takes it. A student may ask for control, and then changes the shared robot and
    acts in the ROS system. A guest only looks.
    """

    PRESENTER = "presenter"
    HELPER = "helper"
    STUDENT = "student"
    GUEST = "guest"

    def includes(self, other: Role) -> bool:
        """Whether this role may what another one may."""
        return _ORDER.index(self) <= _ORDER.index(other)


_ORDER = tuple(Role)


OWNER: Final = "~"
"""In the id of a copy, between that of the document and the person whose it is."""


RELAY: Final = "@relay"
"""In the place of a person, of what a relay is sent for all of its pages."""


def owner_of(document: str) -> str:
    """Return the person whose copy a document is; empty: it is everybody's."""
    return document.partition(OWNER)[2]


def original_of(document: str) -> str:
    """Return the shared document that a copy is of, or the document itself."""
    return document.partition(OWNER)[0]


class Person(Protocol):
    """A person with a role; `person` is the same for all of one browser, or of one token."""

    @property
    def role(self) -> Role:
        """The person's role."""
        ...

    @property
    def person(self) -> str:
        """Identifies the person."""
        ...

    def controls(self, document: str) -> bool:
        """Whether the person has control of a document; empty: of the ROS system."""
        ...

    def sees(self, document: str) -> bool:
        """Whether the person may look at a document: a copy is private until it is shown."""
        ...


class HasControl(Protocol):
    """Who has control of the shared robot and of the ROS system."""

    @property
    def holder(self) -> str:
        """The person who has it; empty: the presenter."""
        ...

    @property
    def document(self) -> str:
        """The shared document that the holder has control of."""
        ...

    @property
    def shown(self) -> str:
        """The copy that everybody may see; empty: none."""
        ...


@dataclass(frozen=True, slots=True)
class Visitor:
    """A person and their role; `person` is the same for all lanes of one cookie or token.

    `control` None: nobody but presenters ever has it.
    """

    role: Role
    person: str = ""
    control: HasControl | None = field(default=None, compare=False)

    def controls(self, document: str) -> bool:
        """Whether the person has control: that of the presenter is every presenter's.

        Of documents that were lent to nobody, and of copies, they have it all the time.
        """
        if self.role is not Role.PRESENTER:
            return False
        control = self.control
        if control is None or not control.holder:
            return True
        return document not in {"", control.document}

    def sees(self, document: str) -> bool:
        """Whether the person may look at a document."""
        if not owner_of(document) or self.role is Role.PRESENTER:
            return True
        return self.control is not None and self.control.shown == document
