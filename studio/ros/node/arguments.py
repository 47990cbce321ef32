"""Arguments: what follows `--ros-args` on a command line: names, remappings and parameters."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from studio.errors import RosArgumentError
from studio.ros.names import expand
from studio.ros.node.logger import LoggingSeverity

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.ros.tokens import NodeToken

BEGIN, END = "--ros-args", "--"
_RULE = re.compile(r"(?:(?P<node>[A-Za-z0-9_/]+):)?(?P<from>[^:=]+):=(?P<to>.*)", re.DOTALL)
_NAMES = {"__node", "__name"}
_SWITCHES = re.compile(r"--(enable|disable)-(rosout-logs|stdout-logs|external-lib-logs)")
_WITH_VALUE = {
    "-r", "--remap", "-p", "--param", "--params-file", "--log-level", "-e", "--enclave",
    "--log-config-file",
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Rule:
    """`node:from:=to`; without a node it counts for all."""

    node: str | None
    source: str
    target: str

    def __str__(self) -> str:
        return f"{self.node or ''}{':' if self.node else ''}{self.source}:={self.target}"

    def is_for(self, name: str) -> bool:
        """Whether it counts for a node of that name."""
        return self.node is None or self.node.rpartition("/")[2] == name


@dataclass(frozen=True, slots=True)
class RosArguments:
    """The ROS arguments of a process.

    Attributes:
        rest: The arguments that are not ROS's.
        remaps: In the order given; the first that matches counts.
        parameters: In the order given; the last one counts.
        files: Parameter files, read before `parameters`.
        levels: Log level by logger, "" for all.
    """

    rest: tuple[str, ...] = ()
    remaps: tuple[Rule, ...] = ()
    parameters: tuple[Rule, ...] = ()
    files: tuple[str, ...] = ()
    levels: tuple[tuple[str, LoggingSeverity], ...] = ()

    def before(self, others: RosArguments) -> RosArguments:
        """Join with others; these come first."""
        return RosArguments(
            self.rest,
            (*self.remaps, *others.remaps),
            (*others.parameters, *self.parameters),
            (*others.files, *self.files),
            (*others.levels, *self.levels),
        )

    def of_node(self, name: str) -> NodeArguments:
        """Return the arguments of the node that has this name in its code."""
        fitting = [rule for rule in self.remaps if rule.is_for(name)]
        return NodeArguments(
            node_name=next((one.target for one in fitting if one.source in _NAMES), None),
            namespace=next((one.target for one in fitting if one.source == "__ns"), None),
            remaps=tuple(one for one in fitting if not one.source.startswith("__")),
            parameters=tuple(rule for rule in self.parameters if rule.is_for(name)),
            files=self.files,
        )


@dataclass(frozen=True, slots=True)
class NodeArguments:
    """The ROS arguments of one node; names are None where none was given."""

    node_name: str | None = None
    namespace: str | None = None
    remaps: tuple[Rule, ...] = ()
    parameters: tuple[Rule, ...] = ()
    files: tuple[str, ...] = field(default_factory=tuple)

    def remapped(self, full_name: str, node: NodeToken) -> str:
        """Return the name of a topic or service after remapping.

        Raises:
            RosNameError: The new name is not valid.
        """
        for rule in self.remaps:
            source = rule.source.removeprefix("rostopic://").removeprefix("rosservice://")
            if expand(source, node.namespace, node.name) == full_name:
                return expand(rule.target, node.namespace, node.name)
        return full_name

    @property
    def values(self) -> list[tuple[str, str]]:
        """Names of parameters, each with its value in YAML."""
        return [(rule.source, rule.target) for rule in self.parameters]


def parse_arguments(arguments: Sequence[str]) -> RosArguments:
    """Read command-line arguments; those outside of `--ros-args ... --` are left.

    Raises:
        RosArgumentError: One is no argument of ROS, or its value cannot be read.
    """
    rest: list[str] = []
    remaps: list[Rule] = []
    parameters: list[Rule] = []
    files: list[str] = []
    levels: list[tuple[str, LoggingSeverity]] = []
    for option, value in _options(arguments, rest):
        match option:
            case "-r" | "--remap":
                remaps.append(_rule(option, value))
            case "-p" | "--param":
                parameters.append(_rule(option, value))
            case "--params-file":
                files.append(value)
            case "--log-level":
                levels.append(_level(value))
            case _:  # -e, --enclave and --log-config-file change nothing that there is here
                pass
    return RosArguments(tuple(rest), tuple(remaps), tuple(parameters), tuple(files), tuple(levels))


def _options(arguments: Sequence[str], rest: list[str]) -> Iterator[tuple[str, str]]:
    of_ros = False
    waiting = iter(arguments)
    for argument in waiting:
        if argument == BEGIN:
            of_ros = True
        elif not of_ros:
            rest.append(argument)
        elif argument == END:
            of_ros = False
        elif argument in _WITH_VALUE:
            value = next(waiting, None)
            if value is None:
                raise RosArgumentError(argument, "a value follows it")
            yield argument, value
        elif not _SWITCHES.fullmatch(argument):
            raise RosArgumentError(argument, "it is none of the arguments that follow --ros-args")


def _rule(option: str, text: str) -> Rule:
    found = _RULE.fullmatch(text)
    if found is None:
        raise RosArgumentError(f"{option} {text}", "write from:=to, or node:from:=to")
    return Rule(found["node"], found["from"], found["to"])


def _level(text: str) -> tuple[str, LoggingSeverity]:
    name, _, level = text.rpartition(":=")
    try:
        return name, LoggingSeverity[level.upper()]
    except KeyError:
        raise RosArgumentError(
            f"--log-level {text}", "a level is debug, info, warn, error or fatal"
        ) from None
