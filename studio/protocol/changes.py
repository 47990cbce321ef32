"""Messages about changes in a ROS 2 system: pages ask again when something changed."""

from __future__ import annotations

from typing import Literal, TypeAlias

from studio.protocol.message import Command, Event

Subject: TypeAlias = Literal["graph", "log", "diagnostics", "goal_statuses", "lessons"]
"""Who is there with what topics, services and actions; lines of the log; how parts of robots are;
the states of goals; demos, and what they print."""


class FollowChanges(Command):
    """Be told when something changed, from now on; or no more."""

    type: Literal["follow_changes"] = "follow_changes"
    subject: Subject
    following: bool = True


class Changed(Event):
    """Something changed, once or several times since this was told last."""

    type: Literal["changed"] = "changed"
    subject: Subject
