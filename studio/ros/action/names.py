"""Names of the parts of an action: three services and two topics below `_action`."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ActionNames:
    """The full names of the parts of an action."""

    send_goal: str
    cancel_goal: str
    get_result: str
    feedback: str
    status: str

    @classmethod
    def of(cls, action: str) -> ActionNames:
        """Name the parts of an action by its full name."""
        return cls(*(f"{action}/_action/{part}" for part in cls.__dataclass_fields__))
