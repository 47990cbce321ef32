"""Roles and persons; what a role may do is in the commands' permissions."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol


class Role(StrEnum):
    """A presenter may do everything; a viewer only watches and moves their own camera."""

    PRESENTER = "presenter"
    VIEWER = "viewer"


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


@dataclass(frozen=True, slots=True)
class Visitor:
    """A person and their role; `person` is the same for all lanes of one cookie or token."""

    role: Role
    person: str = ""
