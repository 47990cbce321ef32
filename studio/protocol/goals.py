"""Messages about goals of actions: sent from pages, and all that a server has."""

from __future__ import annotations

from typing import Literal, TypeAlias

from pydantic import Field

from studio.protocol.calls import Name, PlainJson, Yaml
from studio.protocol.logs import LogLine
from studio.protocol.message import Command, Event, Message

GoalState: TypeAlias = Literal[
    "sending",
    "accepted",
    "executing",
    "canceling",
    "succeeded",
    "canceled",
    "aborted",
    "rejected",
    "failed",
]
"""`rejected`: its server did not take it; `failed`: it is not known what became of it."""


class SendGoal(Command):
    """Send a goal; what becomes of it is told to those who follow goals."""

    type: Literal["send_goal"] = "send_goal"
    name: Name
    action_type: Name
    text: Yaml = ""
    timeout_s: float = Field(default=10.0, gt=0, le=3600)
    """For the server to take or refuse it; the goal itself may take as long as it likes."""


class CancelGoal(Command):
    """Ask that a goal end; refused when its server says no."""

    type: Literal["cancel_goal"] = "cancel_goal"
    operation: int


class GetGoalStatuses(Command):
    """Ask how all goals of an action stand, those of others too."""

    type: Literal["get_goal_statuses"] = "get_goal_statuses"
    name: Name


class FeedbackView(Message):
    """What a server said of a goal under way."""

    number: int
    """From 1 on, among all of this goal."""
    after_s: float
    """Since it was sent."""
    values: PlainJson


class GoalView(Message):
    """A goal, and how far it is."""

    operation: int
    name: str
    action_type: str
    text: str
    state: GoalState
    goal_id: str
    """In hex; empty before it is accepted."""
    began_s: float
    """Seconds since the epoch, by the studio's clock."""
    took_s: float
    feedback_count: int
    feedback: tuple[FeedbackView, ...]
    """What is new since the last time; of all that are told, the last that are kept."""
    result: PlainJson
    trouble: str
    servers: tuple[str, ...]
    """Paths of the nodes that serve the action, told when the goal is over."""
    server_said: LogLine | None
    """What a server that aborted or rejected it logged last as a warning or an error meanwhile."""


class Goals(Event):
    """Goals, the oldest first; all that are kept, or those that changed."""

    type: Literal["goals"] = "goals"
    whole: bool
    operations: tuple[GoalView, ...]


class GoalStatusView(Message):
    """A goal as its server tells of it."""

    goal_id: str
    state: str
    """By the name that action_msgs gives it, in small letters."""
    stamp_s: float
    """When it was accepted, by the server's clock."""
    is_ours: bool


class GoalStatuses(Event):
    """Answer to `get_goal_statuses`, the newest first."""

    type: Literal["goal_statuses"] = "goal_statuses"
    request: int
    name: str
    goals: tuple[GoalStatusView, ...]
