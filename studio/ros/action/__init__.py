"""Actions: goals in; acceptance, feedback, status and one result out, on both ends."""

from studio.ros.action.client import ActionClient, ClientGoalHandle
from studio.ros.action.protocol import GoalStatus
from studio.ros.action.server import ActionServer, CancelResponse, GoalResponse
from studio.ros.action.server_goal import ServerGoalHandle

__all__ = [
    "ActionClient",
    "ActionServer",
    "CancelResponse",
    "ClientGoalHandle",
    "GoalResponse",
    "GoalStatus",
    "ServerGoalHandle",
]
