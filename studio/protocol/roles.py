"""Roles and persons; what a role may do is in the commands' permissions."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol


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
        """Whether the person has control of a document; empty: of the shared robot and ROS."""
        ...


class HasControl(Protocol):
    """Who has control of the shared robot and of the ROS system."""

    @property
    def holder(self) -> str:
        """The person who has it; empty: the presenter."""
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
        """Whether the person has control: that of the presenter is every presenter's."""
        del document
        return self.role is Role.PRESENTER and (self.control is None or not self.control.holder)
