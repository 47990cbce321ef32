"""Students' own ROS nodes: the access that is switched on for them, and what each sees there."""

from __future__ import annotations

from typing import Literal

from studio.protocol.message import Command, Event, Message

NODES_SHOWN = 100
TOPICS_SHOWN = 200


class StartNodes(Command):
    """Let students' own nodes join, each in a ROS domain of its own; makes new credentials."""

    type: Literal["start_nodes"] = "start_nodes"


class StopNodes(Command):
    """Let none of them join any more, and end the connections of those that have."""

    type: Literal["stop_nodes"] = "stop_nodes"


class GetNodeAccess(Command):
    """Ask for the domain and the credentials of your own nodes: the same ones each time."""

    type: Literal["get_node_access"] = "get_node_access"


class NodeAccess(Event):
    """Answer to `get_node_access`, to the asker alone."""

    type: Literal["node_access"] = "node_access"
    request: int
    domain: int
    endpoint: str
    shell: str
    """A line for the shells of Linux and macOS, to be pasted before nodes are started."""
    powershell: str
    """The same for PowerShell."""


class GetMyGraph(Command):
    """Ask what there is in the domain of your own nodes."""

    type: Literal["get_my_graph"] = "get_my_graph"


class OwnTopic(Message):
    """A topic of a student's domain."""

    name: str
    types: tuple[str, ...]
    publishers: int
    subscriptions: int


class MyGraph(Event):
    """Answer to `get_my_graph`; what the studio itself has there is left out."""

    type: Literal["my_graph"] = "my_graph"
    request: int
    domain: int
    nodes: tuple[str, ...]
    topics: tuple[OwnTopic, ...]
    more: int
    """Nodes and topics for which there was no room."""


class StudentNodesState(Event):
    """Whether students' own nodes may join, and where."""

    type: Literal["student_nodes"] = "student_nodes"
    state: Literal["off", "starting", "on", "failed"]
    endpoint: str
    """Empty while it is off."""
    only_here: bool
    """Whether no other machine reaches it."""
    given: int
    """How many people have asked for theirs, and those who were sent out."""
    limit: int
    trouble: str
    """Why it failed, in a sentence."""
