"""Which packages of a workspace need each other: as a graph, in the order of building."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.packages.inspection.inspected import (
    DependencyEdge,
    DependencyGraph,
    DependencyNode,
    Presence,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.packages.inspection.inspected import InspectedPackage


def dependency_graph(packages: Iterable[InspectedPackage]) -> DependencyGraph:
    """Return the graph; a name that several packages bear is one node."""
    edges: dict[tuple[str, str], DependencyEdge] = {}
    needs: dict[str, dict[str, None]] = {}
    outside: dict[str, Presence] = {}
    for package in packages:
        own = needs.setdefault(package.name, {})
        for one in package.dependencies:
            edge = DependencyEdge(package.name, one.name, one.kinds)
            edges.setdefault((package.name, one.name), edge)
            if one.presence is Presence.WORKSPACE:
                own[one.name] = None
            else:
                outside[one.name] = one.presence
    order, cycles = build_order(needs)
    nodes = [DependencyNode(name, Presence.WORKSPACE) for name in order]
    nodes += [DependencyNode(name, presence) for name, presence in sorted(outside.items())]
    return DependencyGraph(tuple(nodes), tuple(edges.values()), cycles)


def build_order(
    needs: Mapping[str, Iterable[str]],
) -> tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]:
    """Return names so that each comes behind what it needs, and the groups that need each other.

    Of a group that needs each other, the order is that in which it was met.
    """
    order: list[str] = []
    groups: list[tuple[str, ...]] = []
    index: dict[str, int] = {}
    lowest: dict[str, int] = {}
    held: list[str] = []
    # Tarjan's algorithm, with a stack of its own: a chain of packages may be long.
    for start in sorted(needs):
        waiting = [(start, iter(sorted(needs.get(start, ()))))] if start not in index else []
        if waiting:
            index[start] = lowest[start] = len(index)
            held.append(start)
        while waiting:
            name, others = waiting[-1]
            other = next(others, None)
            if other is None:
                waiting.pop()
                if waiting:
                    above = waiting[-1][0]
                    lowest[above] = min(lowest[above], lowest[name])
                if lowest[name] == index[name]:
                    cut = held.index(name)
                    group, held[cut:] = tuple(held[cut:]), []
                    order += group
                    if len(group) > 1 or name in needs.get(name, ()):
                        groups.append(group)
            elif other not in index:
                index[other] = lowest[other] = len(index)
                held.append(other)
                waiting.append((other, iter(sorted(needs.get(other, ())))))
            elif other in held:
                lowest[name] = min(lowest[name], index[other])
    return tuple(order), tuple(groups)
