"""Nodes: two of one name, some that the router does not show, some that do not answer."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, called, listed, short
from studio.live.doctor.subjects.router import CONNECTION
from studio.protocol.doctor import Concern, Finding
from studio.ros.graph.diagnosis import why_unseen

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Answers, Seen, System
    from studio.protocol.doctor import SubjectName
    from studio.ros.graph.endpoints import GraphNode

SUBJECT: Final[SubjectName] = "nodes"


def looked_at(seen: Seen) -> Looked | None:
    """The nodes of others."""
    if seen.system is None:
        return None
    asked = f"{seen.answers.asked} asked whether they answer" if seen.answers else ""
    return Looked(len(seen.system.others), asked)


def findings(seen: Seen) -> Iterator[Finding]:
    """Find nodes that are not as their tokens say."""
    if seen.answers is not None:
        yield from _unseen(seen.answers)
    if seen.system is None:
        return
    yield from _twice(seen.system)
    if seen.answers is not None:
        yield from _silent(seen.answers, seen.system)
    count, last = seen.system.malformed
    if count:
        yield Finding(
            code="token",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"{count} liveliness tokens were not understood: what they stand for is not shown."
            ),
            evidence=(f"the last: {short(last, 380)}",),
            about=(CONNECTION,),
        )


def duplicates(system: System) -> dict[str, int]:
    """Return the paths that more than one node has, and how many do."""
    counts = Counter(one.path for one in system.nodes)
    return {path: count for path, count in sorted(counts.items()) if count > 1}


def _twice(system: System) -> Iterator[Finding]:
    for path, count in duplicates(system).items():
        same = [one for one in system.nodes if one.path == path]
        yield Finding(
            code="duplicate-name",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"{count} nodes are called {short(path)}: start all but one with another name."
            ),
            evidence=tuple(
                f"{short(one.path)} {place_of(one)}"
                f"{' (the studio)' if one.zid in system.own else ''}"
                for one in same[:8]
            ),
            line="ros2 run PACKAGE EXECUTABLE --ros-args -r __node:=OTHER_NAME",
            about=(Concern(kind="node", name=path),),
        )


def place_of(node: GraphNode) -> str:
    """Say where a node runs, as far as it is known."""
    return f"behind the {called(node.bridge)}" if node.bridge else f"of process {node.zid[:8]}"


def _unseen(answers: Answers) -> Iterator[Finding]:
    if answers.unseen is not None:
        yield Finding(
            code="unseen-nodes",
            level="error",
            subject=SUBJECT,
            sentence=why_unseen(answers.unseen),
            evidence=(
                f"processes that publish without a token: {answers.unseen.count}",
                f"Zenoh of these: {listed(answers.unseen.versions) or 'they do not tell'}",
                f"Zenoh of routers: {listed(answers.unseen.router_versions) or 'they do not tell'}",
            ),
            about=(CONNECTION,),
        )


def _silent(answers: Answers, system: System) -> Iterator[Finding]:
    there = {one.path: one for one in system.nodes}
    dead = {one.path for one in system.nodes if one.zid in answers.lost and not one.bridge}
    cut_off = {one.path for one in system.nodes if one.zid in answers.lost and one.bridge}
    for path in sorted(dead):
        yield Finding(
            code="dead-node",
            level="error",
            subject=SUBJECT,
            sentence=(
                f"{short(path)} is listed, and its process answers nobody any more: it was killed "
                "or cut off, and the router keeps its token for a minute."
            ),
            evidence=(f"process {there[path].zid[:8]} told its version before, and does no more",),
            about=(Concern(kind="node", name=path),),
        )
    for path in answers.silent:
        if path not in there or path in dead | cut_off:  # it ended meanwhile, or is said elsewhere
            continue
        bridge = there[path].bridge
        asked = f" when asked through the {called(bridge)}" if bridge else ""
        yield Finding(
            code="silent-node",
            level="warn",
            subject=SUBJECT,
            sentence=(
                f"{short(path)} is listed and does not answer{asked}: it is busy in a callback, is "
                "not spun, was stopped, or is dead and not yet gone from the list."
            ),
            evidence=(f"{short(path)}/get_parameters gave no answer in 2 s",),
            line=f"ros2 param list {short(path)}",
            about=(Concern(kind="node", name=path),),
        )
