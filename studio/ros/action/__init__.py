"""Actions: goals in; acceptance, feedback, status and one result out, on both ends."""

from studio.ros.action.answers import CancelResponse, GoalResponse
from studio.ros.action.client import ActionClient
from studio.ros.action.client_goal import ClientGoalHandle
from studio.ros.action.server import ActionServer
from studio.ros.action.server_goal import ServerGoalHandle
from studio.ros.action.states import GoalStatus

__all__ = [
    "ActionClient",
    "ActionServer",
    "CancelResponse",
    "ClientGoalHandle",
    "GoalResponse",
    "GoalStatus",
    "ServerGoalHandle",
]
