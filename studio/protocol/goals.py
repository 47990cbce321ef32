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
    """Send a goal; those who follow goals receive what becomes of it."""

    type: Literal["send_goal"] = "send_goal"
    name: Name
    action_type: Name
    text: Yaml = ""
    timeout_s: float = Field(default=10.0, gt=0, le=3600)
    """For the server to accept or reject it; the goal itself may take any time."""


class CancelGoal(Command):
    """Ask a server to cancel a goal; refused when the server refuses."""

    type: Literal["cancel_goal"] = "cancel_goal"
    operation: int


class GetGoalStatuses(Command):
    """Ask for the states of all goals of an action, those of others too."""

    type: Literal["get_goal_statuses"] = "get_goal_statuses"
    name: Name


class FeedbackView(Message):
    """One feedback message of a running goal."""

    number: int
    """Counts all of this goal, from 1."""
    after_s: float
    """Since the goal was sent."""
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
    """Those since the last event; where the whole goal is sent, the last that are kept."""
    result: PlainJson
    trouble: str
    servers: tuple[str, ...]
    """Full names of the nodes that serve the action, sent when the goal is over."""
    server_said: LogLine | None
    """The last warning or error that a server logged during a goal that it aborted or rejected."""


class Goals(Event):
    """Goals, the oldest first; all that are kept, or those that changed."""

    type: Literal["goals"] = "goals"
    whole: bool
    operations: tuple[GoalView, ...]


class GoalStatusView(Message):
    """A goal as its server reports it."""

    goal_id: str
    state: str
    """The name in action_msgs, in lower case."""
    stamp_s: float
    """When it was accepted, by the server's clock."""
    is_ours: bool


class GoalStatuses(Event):
    """Answer to `get_goal_statuses`, the newest first."""

    type: Literal["goal_statuses"] = "goal_statuses"
    request: int
    name: str
    goals: tuple[GoalStatusView, ...]
