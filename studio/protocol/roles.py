"""Who somebody is in the studio; what a role may do is in the commands' permissions."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Protocol


class Role(StrEnum):
    """A presenter may do everything, a viewer looks and moves their own camera."""

    PRESENTER = "presenter"
    VIEWER = "viewer"


class Person(Protocol):
    """Somebody with a role; `person` is the same for all of one browser, or of one token."""

    @property
    def role(self) -> Role:
        """What they may do."""
        ...

    @property
    def person(self) -> str:
        """Who they are."""
        ...


@dataclass(frozen=True, slots=True)
class Visitor:
    """Who asks: `person` is the same for all that comes with one cookie, or with one token."""

    role: Role
    person: str = ""
