"""Which goals a request to cancel means, and what it is answered."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import TYPE_CHECKING

from studio.ros.action.states import GoalEvent, GoalStatus, can_follow

if TYPE_CHECKING:
    from collections.abc import Iterable

GOAL_ID_BYTES = 16
ANY_GOAL = bytes(GOAL_ID_BYTES)


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


def goals_meant(
    goals: Iterable[KnownGoal], goal_id: bytes, stamp_ns: int
) -> tuple[list[KnownGoal], CancelCode]:
    """Choose the goals that a request asks to end, and the code if nobody objects.

    An id of zeros is any goal, a stamp of 0 any time; a stamp means those accepted until then,
    beside the one that is named.
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
