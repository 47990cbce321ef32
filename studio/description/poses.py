# PyYAML's nodes and events are untyped.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""Named joint positions from the files around a robot: group states, initial positions, one's own.

- `<group_state name group>` of an SRDF, as MoveIt reads it, holds `<joint name value>`. The SRDF is
  expanded as a robot description is. A joint of several degrees of freedom has several numbers.
- A file of initial positions is one map from joint to position, bare or under `initial_positions`,
  as MoveIt's setup assistant and the descriptions of Universal Robots write it. xacro's units
  (`!degrees 90`) hold here too.
- A person's own poses are a small YAML beside the robot's, read as hostile. Poses that did not
  change keep their lines, comments included. A text that reads back as anything else than what was
  to be written is written again as a whole.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from itertools import islice
from pathlib import PurePath
from typing import TYPE_CHECKING, Final, cast

from studio.description.faults import Fault
from studio.description.syntax.named_list import (
    SIZE_LIMIT_BYTES,
    VERSION,
    ListKind,
    NamedList,
    lines_of,
)
from studio.description.syntax.yaml_reading import read_yaml
from studio.description.syntax.yaml_spans import yaml_bytes
from studio.errors import EditError, PosesFileError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import yaml

    from studio.description.values import Expansion, Part

JOINT_LIMIT: Final = 2_000
"""Joints of one pose."""
NAME_LIMIT: Final = 100
_NUMBER: Final = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_LARGEST: Final = 1e9
"""rad or m; no joint goes so far."""
INITIAL_POSITIONS_LIMIT_BYTES: Final = 1 << 18
_KEY: Final = "initial_positions"
POSE_LIMIT: Final = 200
_DIGITS: Final = 9
"""Behind the point: a nanometre."""
_KIND: Final = ListKind(
    noun="pose",
    error=PosesFileError,
    item_limit=POSE_LIMIT,
    entry_limit=JOINT_LIMIT,
    depth_limit=6,
)
_HEAD: Final = (
    "# Poses of {entry}: named joint positions, rad or m.\n"
    "# Written by the studio; edit it as you like.\n"
    f"version: {VERSION}\n"
    "poses:\n"
)


@dataclass(frozen=True, slots=True)
class NamedPose:
    """Positions of some joints of a robot; the others stay where they are."""

    name: str
    positions: dict[str, float]
    """By joint, rad or m."""
    group: str = ""
    """The planning group that an SRDF states it for."""
    file: str = ""
    line: int = 0
    """From 1; 0 when it is not known."""
    unread: tuple[str, ...] = ()
    """Joints whose value is no single number, such as those of a floating joint."""


def position_of(text: str) -> float | None:
    """Return a position as written, rad or m; None when it is no finite number in range."""
    trimmed = text.strip()
    if len(trimmed) > 100 or not _NUMBER.fullmatch(trimmed):
        return None
    value = float(trimmed)
    return value if math.isfinite(value) and abs(value) <= _LARGEST else None


def group_states(expansion: Expansion) -> Iterator[NamedPose]:
    """Yield the states of an SRDF's run, in order, without those lacking a name or joint."""
    for part in expansion.changed_parts:
        if part.element.tag == "group_state":
            pose = _pose(part)
            if pose.name and (pose.positions or pose.unread):
                yield pose


def _pose(part: Part) -> NamedPose:
    element = part.element
    positions: dict[str, float] = {}
    unread: list[str] = []
    for joint in islice(element.elements("joint"), JOINT_LIMIT):
        name = joint.get("name", "")
        value = position_of(joint.get("value", ""))
        if value is None:
            unread.append(name)
        elif name:
            positions[name] = value
    return NamedPose(
        name=element.get("name", "").strip()[:NAME_LIMIT],
        positions=positions,
        group=element.get("group", "").strip()[:NAME_LIMIT],
        file=part.place.file,
        line=part.place.line,
        unread=tuple(unread),
    )


def initial_positions(path: str, data: bytes) -> NamedPose | None:
    """Return the pose of a file; None when it is no map of joints to numbers."""
    try:
        found = cast("object", read_yaml(path, data, float))
    except (Fault, ValueError):
        return None
    whole = cast("dict[object, object]", found) if isinstance(found, dict) else {}
    positions = _positions(whole.get(_KEY, whole))
    if not positions:
        return None
    name = PurePath(path).stem[:NAME_LIMIT]
    return NamedPose(name=name, positions=positions, file=path, line=1)


def _positions(found: object) -> dict[str, float] | None:
    if not isinstance(found, dict) or len(cast("dict[object, object]", found)) > JOINT_LIMIT:
        return None
    positions: dict[str, float] = {}
    for joint, value in cast("dict[object, object]", found).items():
        if isinstance(value, bool) or not isinstance(value, int | float):
            return None
        position = position_of(repr(value))
        if not isinstance(joint, str) or position is None:
            return None
        positions[joint] = position
    return positions


@dataclass(frozen=True, slots=True)
class _Item:
    """One pose of a file and its lines [start, end) there."""

    pose: NamedPose
    start: int
    end: int


def rounded(position: float) -> float:
    """Return a position as the file holds it."""
    return round(position, _DIGITS) + 0.0  # never -0


def read_poses(path: str, data: bytes) -> tuple[NamedPose, ...]:
    """Return the poses of a file, in its order; an empty file has none.

    Raises:
        PosesFileError: It is no YAML, too large, or has something that no pose can have.
    """
    return tuple(item.pose for item in _Reading(path, data).items())


def write_poses(path: str, entry: str, before: bytes, poses: Sequence[NamedPose]) -> bytes:
    """Return the bytes of a file with these poses, otherwise unchanged as far as possible.

    Args:
        path: Path of the file, for errors.
        entry: Name of the entry file, for a new file's first line.
        before: The present content; empty for none.
        poses: All of them, in order; their positions `rounded`.

    Raises:
        PosesFileError: The present file, or the new one, cannot be read.
    """
    written = _woven(path, before, poses) if before.strip() and poses else None
    if written is None or not _reads_as(path, written, poses):
        head = _HEAD.format(entry=entry.replace("\n", " "))
        written = (head + "".join(map(_text, poses))).encode("utf-8", "replace")
    if len(written) > SIZE_LIMIT_BYTES:
        raise PosesFileError(path, "the poses are too many for one file; delete some")
    if not _reads_as(path, written, poses):
        raise PosesFileError(path, "a name in it is one that a file cannot hold; choose another")
    return written


def _reads_as(path: str, written: bytes, poses: Sequence[NamedPose]) -> bool:
    try:
        found = read_poses(path, written)
    except PosesFileError:
        return False
    return [(one.name, one.positions) for one in found] == [
        (one.name, one.positions) for one in poses
    ]


def _woven(path: str, before: bytes, poses: Sequence[NamedPose]) -> bytes | None:
    """Return the file with the lines of each pose in their order; None when it has none to keep."""
    items = _Reading(path, before).items()
    lines = before.decode("utf-8-sig").splitlines(keepends=True)
    if not items:
        return None
    blocks = _blocks(items)
    known = {item.pose.name: (item.pose, block) for item, block in zip(items, blocks, strict=True)}
    body: list[str] = []
    for pose in poses:
        old, (start, end) = known.get(pose.name, (None, (0, 0)))
        same = old is not None and old.positions == pose.positions
        body.append("".join(lines[start:end]) if same else _text(pose))
    first, last = blocks[0][0], blocks[-1][1]
    body = [block if block.endswith("\n") else f"{block}\n" for block in body]
    return "".join((*lines[:first], *body, *lines[last:])).encode()


def _blocks(items: Sequence[_Item]) -> list[tuple[int, int]]:
    """Return the lines of each pose, with the comments above it after the pose before."""
    ends = [items[0].start, *(item.end for item in items)]
    return [(ends[at], item.end) for at, item in enumerate(items)]


def _text(pose: NamedPose) -> str:
    joints = [f"      {_plain(name)}: {_number(value)}" for name, value in pose.positions.items()]
    head = "    joints:" if joints else "    joints: {}"
    return "\n".join([f"  - name: {_plain(pose.name)}", head, *joints, ""])


def _plain(text: str) -> str:
    try:
        return yaml_bytes(text, b"x").decode()
    except EditError:
        return '""'  # which does not read back as it was, and so is reported


def _number(value: float) -> str:
    return f"{value:.{_DIGITS}f}".rstrip("0").rstrip(".")


class _Reading:
    """Reads a file once; every fault names its line."""

    def __init__(self, path: str, data: bytes) -> None:
        self._path, self._list = path, NamedList(path, data, _KIND)

    def items(self) -> tuple[_Item, ...]:
        return tuple(map(self._item, self._list.items()))

    def _item(self, node: yaml.Node) -> _Item:
        keys = self._list.mapping(node, {"name", "joints"})
        if "joints" not in keys:
            raise self._list.fault(node, "is a pose without joints")
        joints = self._list.mapping(keys["joints"], None)
        positions = {joint: self._position(value) for joint, value in joints.items()}
        start, end = lines_of(node)
        pose = NamedPose(self._list.name(node), positions, file=self._path, line=start + 1)
        return _Item(pose, start, end)

    def _position(self, node: yaml.Node) -> float:
        value = position_of(self._list.text(node))
        if value is None:
            raise self._list.fault(node, "is no position in rad or m")
        return rounded(value)
