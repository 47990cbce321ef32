"""What the graph shows of a program's own nodes: names that clash, QoS that does not match."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING, Final

from studio.importable.hints.said import place_of, tree_of
from studio.ros.names import is_hidden
from studio.ros.qos import why_unmatched
from studio.ros.tokens import EndpointKind

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.importable.hints.said import Said
    from studio.ros.graph.endpoints import GraphEndpoint
    from studio.ros.graph.graph import Graph

_NOISE: Final = frozenset({"/rosout", "/parameter_events"})
_COMPARED_MAX: Final = 50
"""Of one topic: those that differ are among the first."""
_MAKES: Final = {
    EndpointKind.PUBLISHER: "create_publisher",
    EndpointKind.SUBSCRIPTION: "create_subscription",
}


class Ends:
    """Compares what the program's nodes offer and ask for with what others do."""

    def __init__(self, said: Said, zid: str, graph: Graph) -> None:
        self._said, self._zid, self._graph = said, zid, graph
        self._version = -1

    def look(self, files: frozenset[str]) -> None:
        """Look once, if the graph has changed.

        Args:
            files: The program's own.
        """
        if (version := self._graph.version) == self._version:
            return
        self._version = version
        nodes = self._graph.nodes()
        own = [node for node in nodes if node.zid == self._zid]
        for node in own:
            same = sum(other.path == node.path for other in nodes)
            if same > 1:
                self._said.say(
                    f"name {node.path}",
                    f"{same} nodes are called {node.path}: what is asked of one may be answered by "
                    "the other; give one another name, with --ros-args -r __node:=NAME.",
                )
            for mine in self._graph.endpoints_of(node):
                self._compare(mine, files)

    def _compare(self, mine: GraphEndpoint, files: frozenset[str]) -> None:
        if mine.name in _NOISE or is_hidden(mine.name) or mine.kind not in _MAKES:
            return
        publishes = mine.kind is EndpointKind.PUBLISHER
        others = (
            self._graph.subscriptions(mine.name) if publishes else self._graph.publishers(mine.name)
        )
        for other in others[:_COMPARED_MAX]:
            if other.type_name != mine.type_name:
                continue
            offered, asked = (mine, other) if publishes else (other, mine)
            for reason in why_unmatched(offered.qos, asked.qos):
                self._say(mine, offered, asked, reason, files)

    def _say(
        self,
        mine: GraphEndpoint,
        offered: GraphEndpoint,
        asked: GraphEndpoint,
        reason: str,
        files: frozenset[str],
    ) -> None:
        at = next(_lines(files, mine), "")
        self._said.say(
            f"qos {mine.kind} {mine.name} {reason}",
            f"ROS 2 on DDS would deliver nothing on {mine.name} from {offered.node.path} to "
            f"{asked.node.path}{f' ({at})' if at else ''}: {reason}; Zenoh carries it, but write "
            "the same QoS on both sides.",
        )


def _lines(files: frozenset[str], end: GraphEndpoint) -> Iterator[str]:
    """Yield where the program makes an end of a topic: the lines with its name in that call."""
    name = end.name.rpartition("/")[2]
    for file in sorted(files):
        tree = tree_of(file)
        for node in ast.walk(tree) if tree else ():
            if isinstance(node, ast.Call) and _makes(node, _MAKES[end.kind], name):
                yield place_of(file, node.lineno)


def _makes(call: ast.Call, method: str, topic: str) -> bool:
    if not (isinstance(call.func, ast.Attribute) and call.func.attr == method):
        return False
    values = [*call.args, *(one.value for one in call.keywords)]
    return any(
        isinstance(one, ast.Constant)
        and isinstance(one.value, str)
        and one.value.rpartition("/")[2] == topic
        for one in values
    )
