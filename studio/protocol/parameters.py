"""Messages about the parameters of nodes: list, set, save, and follow their changes."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.calls import Name, PlainJson, Yaml
from studio.protocol.interfaces import NAME_MAX
from studio.protocol.message import Command, Event, Message


class GetParameterNodes(Command):
    """Ask which nodes have parameters."""

    type: Literal["get_parameter_nodes"] = "get_parameter_nodes"


class GetParameters(Command):
    """Ask for all parameters of a node, with their descriptors."""

    type: Literal["get_parameters"] = "get_parameters"
    node: Name


class SetParameter(Command):
    """Set a parameter of a node; refused with the node's reason when it does not."""

    type: Literal["set_parameter"] = "set_parameter"
    node: Name
    name: Name
    text: Yaml
    """The value, as `ros2 param set` takes it."""
    value_type: str = Field(default="", max_length=40)
    """As in the parameter's view; empty: as the text reads."""


class DumpParameters(Command):
    """Ask for all parameters of a node as a file of them."""

    type: Literal["dump_parameters"] = "dump_parameters"
    node: Name


class LoadParameters(Command):
    """Set what a parameter file has for a node, one parameter after another."""

    type: Literal["load_parameters"] = "load_parameters"
    node: Name
    text: Yaml


class FollowParameters(Command):
    """Receive changes of a node's parameters."""

    type: Literal["follow_parameters"] = "follow_parameters"
    node: str = Field(default="", max_length=NAME_MAX)
    """Empty: of no node any more."""


class ParameterNodes(Event):
    """Answer to `get_parameter_nodes`: full names, in order."""

    type: Literal["parameter_nodes"] = "parameter_nodes"
    request: int
    nodes: tuple[str, ...]


class ParameterView(Message):
    """A parameter and its descriptor."""

    name: str
    value_type: str
    """As `ros2 param describe` writes it: `bool`, `integer`, `double array` ..."""
    value: PlainJson
    description: str = ""
    read_only: bool = False
    constraints: str = ""
    low: float | None = None
    high: float | None = None
    step: float = 0.0
    """0: any value of the range."""


class Parameters(Event):
    """Answer to `get_parameters`, in the order of the alphabet."""

    type: Literal["parameters"] = "parameters"
    request: int
    node: str
    parameters: tuple[ParameterView, ...]


class ParameterDump(Event):
    """Answer to `dump_parameters`."""

    type: Literal["parameter_dump"] = "parameter_dump"
    request: int
    node: str
    text: str


class ParameterRefusal(Message):
    """A parameter that a node did not set, and why."""

    name: str
    reason: str


class ParametersLoaded(Event):
    """Answer to `load_parameters`."""

    type: Literal["parameters_loaded"] = "parameters_loaded"
    request: int
    node: str
    count: int
    """How many were set."""
    refused: tuple[ParameterRefusal, ...]


class ParametersChanged(Event):
    """Parameters of a node that is followed have new values."""

    type: Literal["parameters_changed"] = "parameters_changed"
    node: str
    parameters: tuple[ParameterView, ...]
    """With values, without descriptors."""
    gone: tuple[str, ...]
