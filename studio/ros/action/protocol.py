"""Shared by clients and servers of actions: names and QoS of parts, goal ids, states."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from enum import IntEnum, StrEnum
from typing import TYPE_CHECKING

from studio.errors import GoalStateError
from studio.ros.names import action_part
from studio.ros.qos import QoSProfile
from studio.ros.types.classes import shown

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

GOAL_ID_BYTES = 16
ANY_GOAL = bytes(GOAL_ID_BYTES)
UUID = "unique_identifier_msgs/msg/UUID"
FEEDBACK_QOS = QoSProfile(depth=10)


class GoalStatus(IntEnum):
    """State of a goal."""

    UNKNOWN = 0
    ACCEPTED = 1
    EXECUTING = 2
    CANCELING = 3
    SUCCEEDED = 4
    CANCELED = 5
    ABORTED = 6

    @classmethod
    def _missing_(cls, value: object) -> GoalStatus:
        """Return UNKNOWN for any other number, which a peer may send."""
        del value
        return cls.UNKNOWN

    @property
    def is_over(self) -> bool:
        """Whether the goal has its end; its state changes no more."""
        return self >= GoalStatus.SUCCEEDED

    @property
    def is_active(self) -> bool:
        """Whether the goal runs or waits to."""
        return GoalStatus.ACCEPTED <= self <= GoalStatus.CANCELING


class GoalEvent(StrEnum):
    """What happens to a goal, phrased for errors."""

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
    """Return the state after an event.

    Raises:
        GoalStateError: The event does not follow.
    """
    following = _NEXT.get((status, event))
    if following is None:
        raise GoalStateError(status.name.lower(), event.value)
    return following


class CancelCode(IntEnum):
    """The answer to a request to cancel, by the numbers of action_msgs."""

    ERROR_NONE = 0
    ERROR_REJECTED = 1
    ERROR_UNKNOWN_GOAL_ID = 2
    ERROR_GOAL_TERMINATED = 3


@dataclass(frozen=True, slots=True)
class KnownGoal:
    """A goal as a request to cancel sees it; `accepted_ns` is since the epoch."""

    goal_id: bytes
    accepted_ns: int
    status: GoalStatus


def goals_to_cancel(
    goals: Iterable[KnownGoal], goal_id: bytes, stamp_ns: int
) -> tuple[list[KnownGoal], CancelCode]:
    """Return the goals that a request asks to cancel, and the code if no callback refuses.

    An id of zeros means any goal, a stamp of 0 any time; another stamp means the goals accepted
    until then, in addition to the one with the id.
    """
    known = list(goals)
    named = next((goal for goal in known if goal.goal_id == goal_id), None)
    if goal_id != ANY_GOAL and stamp_ns == 0:
        if named is None:
            return [], CancelCode.ERROR_UNKNOWN_GOAL_ID
        if not _can_end(named):
            return [], CancelCode.ERROR_GOAL_TERMINATED
        return [named], CancelCode.ERROR_NONE
    until = [goal for goal in known if stamp_ns == 0 or goal.accepted_ns <= stamp_ns]
    meant = [goal for goal in known if (goal in until or goal is named) and _can_end(goal)]
    return meant, CancelCode.ERROR_NONE


def _can_end(goal: KnownGoal) -> bool:
    return can_follow(goal.status, GoalEvent.CANCEL_GOAL)


def new_goal_id() -> bytes:
    """Make an id that no other goal has."""
    return uuid.uuid4().bytes


def goal_id_of(message: MessageValue) -> bytes:
    """Return the bytes of a UUID message."""
    return bytes(message.uuid)


def goal_id_message(types: TypeLibrary, goal_id: bytes) -> MessageValue:
    """Make a UUID message.

    Raises:
        ValueError: It has not 16 bytes.
    """
    if len(goal_id) != GOAL_ID_BYTES:
        raise ValueError(f"a goal has an id of {GOAL_ID_BYTES} bytes, not {shown(goal_id)}")
    return types.message(UUID)(uuid=goal_id)


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
        return cls(*(action_part(action, part) for part in cls.__dataclass_fields__))


@dataclass(frozen=True, slots=True)
class ActionQos:
    """One profile for each part; those of client and server have to match."""

    goal: QoSProfile
    result: QoSProfile
    cancel: QoSProfile
    feedback: QoSProfile
    status: QoSProfile
