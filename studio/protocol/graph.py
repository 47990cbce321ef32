"""The ROS graph: nodes, topics and services, and the states of managed nodes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import Command, Event, Message

NODES_MAX = 1_000
LINKS_MAX = 4_000


class GetGraph(Command):
    """Ask who is there, unless that is known already."""

    type: Literal["get_graph"] = "get_graph"
    known: int = Field(default=-1, ge=-1)
    """The `version` of what is known; -1: nothing is."""


class GraphNodeView(Message):
    """The nodes of one name."""

    name: str
    count: int
    """How many nodes have this name; more than one is a fault."""
    own: bool
    """Whether it is the studio's."""
    bridge: str
    """The bridge to DDS that they are behind, or several; empty: none is on DDS."""


class GraphLinkView(Message):
    """A topic, a service or an action between nodes."""

    kind: Literal["topic", "service", "action"]
    name: str
    types: tuple[str, ...]
    sources: tuple[int, ...]
    """Places among the nodes: who publishes, calls, or sends goals."""
    targets: tuple[int, ...]
    """The subscribers or servers."""
    hidden: bool
    """Whether a part of its name begins with an underscore."""


class GraphAnswer(Event):
    """Answer to `get_graph`."""

    type: Literal["graph"] = "graph"
    request: int
    version: int
    """With another one than asked about comes the whole graph, else nothing."""
    nodes: tuple[GraphNodeView, ...]
    links: tuple[GraphLinkView, ...]
    other_count: int
    """Nodes that are not the studio's, as `wire_state` counts them."""
    more: int
    """Nodes and links for which there was no room."""


class GetNode(Command):
    """Ask what a node has."""

    type: Literal["get_node"] = "get_node"
    name: str = Field(max_length=300)


class EndView(Message):
    """A name and its type."""

    name: str
    type: str


class NodeAnswer(Event):
    """Answer to `get_node`: what it has, grouped as `ros2 node info` does."""

    type: Literal["node"] = "node"
    request: int
    name: str
    count: int
    """How many nodes have that name, of which one is described; 0: none has."""
    subscribers: tuple[EndView, ...]
    publishers: tuple[EndView, ...]
    service_servers: tuple[EndView, ...]
    service_clients: tuple[EndView, ...]
    action_servers: tuple[EndView, ...]
    action_clients: tuple[EndView, ...]


MANAGED_MAX = 100


class GetManaged(Command):
    """Ask in which state the managed nodes are; each of them is asked."""

    type: Literal["get_managed"] = "get_managed"


class TransitionView(Message):
    """A transition that a node can be asked for."""

    id: int
    label: str
    goal: str
    """The state that it leads to first."""


class ManagedNodeView(Message):
    """A managed node."""

    name: str
    state_id: int
    """1 unconfigured, 2 inactive, 3 active, 4 finalized; from 10 on between two; 0: not known."""
    state: str
    transitions: tuple[TransitionView, ...]
    trouble: str
    """Why its state is not known, in a sentence."""


class ManagedNodes(Event):
    """Answer to `get_managed`."""

    type: Literal["managed_nodes"] = "managed_nodes"
    request: int
    nodes: tuple[ManagedNodeView, ...]
    more: int
    """Managed nodes that were not asked, for there are too many."""


class ChangeState(Command):
    """Trigger a transition of a managed node; done when it was made, else refused."""

    type: Literal["change_state"] = "change_state"
    node: str = Field(max_length=300)
    transition: int = Field(ge=0, le=255)
