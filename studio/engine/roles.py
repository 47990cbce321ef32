"""Who somebody is in the studio; what a role may do is decided at the door (`web.access`)."""

from enum import StrEnum


class Role(StrEnum):
    """A presenter may do everything, a viewer looks and moves their own camera."""

    PRESENTER = "presenter"
    VIEWER = "viewer"
