"""States of goals, by the numbers of action_msgs, and which follows which."""

from __future__ import annotations

from enum import IntEnum, StrEnum

from studio.errors import GoalStateError


class GoalStatus(IntEnum):
    """How far a goal is."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @classmethod
    def _missing_(cls, value: object) -> GoalStatus:
        """Take a number that is none, as any peer may send, for one that says nothing."""
        del value
        return cls.UNKNOWN

    @property
    def is_over(self) -> bool:
        """Whether the goal has its end; its state changes no more."""
        return self >= GoalStatus.SUCCEEDED

    @property
    def is_active(self) -> bool:
        """Whether the goal is under way."""
        return GoalStatus.ACCEPTED <= self <= GoalStatus.CANCELING


class GoalEvent(StrEnum):
    """What happens to a goal, in the words that errors use."""

    EXECUTE = "be executed"
    CANCEL_GOAL = "be asked to end"
    SUCCEED = "succeed"
    ABORT = "be aborted"
    CANCELED = "end canceled"


_NEXT = {
    (GoalStatus.ACCEPTED, GoalEvent.EXECUTE): GoalStatus.EXECUTING,
    (GoalStatus.ACCEPTED, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.CANCEL_GOAL): GoalStatus.CANCELING,
    (GoalStatus.EXECUTING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.EXECUTING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.SUCCEED): GoalStatus.SUCCEEDED,
    (GoalStatus.CANCELING, GoalEvent.ABORT): GoalStatus.ABORTED,
    (GoalStatus.CANCELING, GoalEvent.CANCELED): GoalStatus.CANCELED,
}


def can_follow(status: GoalStatus, event: GoalEvent) -> bool:
    """Whether that may happen to a goal in that state."""
    return (status, event) in _NEXT


def next_status(status: GoalStatus, event: GoalEvent) -> GoalStatus:
    """Give the state after an event.

    Raises:
        GoalStateError: The event does not follow.
    """
    following = _NEXT.get((status, event))
    if following is None:
        raise GoalStateError(status.name.lower(), event.value)
    return following
