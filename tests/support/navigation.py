"""A server of `nav2_msgs/action/NavigateToPose` in a node that alone knows the type."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from studio.ros.action import ActionServer, CancelResponse
from studio.ros.types.library import TypeLibrary
from tests.support.demos import node_at
from tests.support.goals import Held
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.action import ServerGoalHandle
    from studio.ros.types.library import ActionType

NAVIGATE = "nav2_msgs/action/NavigateToPose"
TEXT = """geometry_msgs/PoseStamped pose
string behavior_tree
---
uint16 NONE=0
uint16 error_code
string error_msg
---
geometry_msgs/PoseStamped current_pose
builtin_interfaces/Duration navigation_time
builtin_interfaces/Duration estimated_time_remaining
int16 number_of_recoveries
float32 distance_remaining
"""
"""As nav2 of Jazzy defines it, less its comments."""


class Navigator(Held):
    """Drives nowhere; the test tells how far it is, and how it ends."""

    def __init__(self, kind: ActionType) -> None:
        super().__init__()
        self._kind = kind

    def goal(self, place: int = 0) -> ServerGoalHandle:
        """A goal that is under way."""
        wait_until("the goal is under way", lambda: len(self.goals) > place)
        return self.goals[place]

    def tell(self, distance_m: float, *, recoveries: int = 0, seconds: int = 0) -> None:
        """Publish feedback of the first goal."""
        goal = self.goal()
        feedback: Any = self._kind.Feedback()
        feedback.distance_remaining = distance_m
        feedback.number_of_recoveries = recoveries
        feedback.navigation_time.sec = seconds
        goal.publish_feedback(feedback)


@contextmanager
def navigator(endpoint: str, name: str = "/navigate_to_pose") -> Generator[Navigator]:
    """The server, at a router; it lets every goal be canceled."""
    types = TypeLibrary("jazzy")
    types.add_texts({NAVIGATE: TEXT})
    with node_at(endpoint, "bt_navigator", types) as node:
        kind = types.action(NAVIGATE)
        work = Navigator(kind)
        server = ActionServer(
            node, kind, name, work, cancel_callback=lambda _: CancelResponse.ACCEPT
        )
        yield work
        for place, future in enumerate(work.futures):
            if not future.done():
                work.end("abort", place)
        server.destroy()
