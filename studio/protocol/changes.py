"""Messages about changes in a ROS 2 system: pages ask again when something changed."""

from __future__ import annotations

from typing import ClassVar, Literal, TypeAlias

from studio.protocol.message import Command, Event

Subject: TypeAlias = Literal[
    "graph",
    "log",
    "diagnostics",
    "goal_statuses",
    "lessons",
    "lesson_list",
    "ticks",
    "workspaces",
    "runs",
]
"""The graph of nodes, topics, services and actions; lines of the log; diagnostics; states of goals;
demos and their output; which lessons there are; who reads them and has done which step; packages
of the opened folders; what was started out of the page, and its output."""


class FollowChanges(Command):
    """Receive `changed` for a subject from now on; or no more."""

    type: Literal["follow_changes"] = "follow_changes"
    subject: Subject
    following: bool = True


class Changed(Event):
    """The subject changed, once or several times since the last such event."""

    is_moment: ClassVar[bool] = True
    type: Literal["changed"] = "changed"
    subject: Subject
