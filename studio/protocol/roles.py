"""Who somebody is in the studio; what a role may do is decided at the door (`web.access`)."""

from dataclasses import dataclass
from enum import StrEnum


class Role(StrEnum):
    """A presenter may do everything, a viewer looks and moves their own camera."""

    PRESENTER = "presenter"
    VIEWER = "viewer"


@dataclass(frozen=True, slots=True)
class Visitor:
    """Who asks: `person` is the same for all that comes with one cookie, or with one token."""

    role: Role
    person: str = ""
