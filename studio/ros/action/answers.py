"""What the callbacks of an action's server answer, and those that stand when a user gives none."""

from __future__ import annotations

import inspect
from enum import IntEnum
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.action.server_goal import ServerGoalHandle


class GoalResponse(IntEnum):
    """Whether a goal is taken."""

    REJECT = 1
    ACCEPT = 2


class CancelResponse(IntEnum):
    """Whether a goal will end when it is asked to."""

    REJECT = 1
    ACCEPT = 2


def default_goal_callback(goal_request: object) -> GoalResponse:
    """Take every goal."""
    del goal_request
    return GoalResponse.ACCEPT


def default_handle_accepted_callback(goal_handle: ServerGoalHandle) -> None:
    """Begin to work on a goal at once."""
    goal_handle.execute()


def default_cancel_callback(cancel_request: object) -> CancelResponse:
    """Let no goal end before its time."""
    del cancel_request
    return CancelResponse.REJECT


async def called(callback: Callable[..., Any], *arguments: object) -> Any:  # noqa: ANN401
    """Call a function or coroutine function, and give what it returns."""
    result = callback(*arguments)
    return await result if inspect.isawaitable(result) else result
