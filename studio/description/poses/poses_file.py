# PyYAML's nodes and events are untyped.
# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""The file of a person's own poses: a small YAML beside the robot's, read as hostile.

What a person wrote stays: poses that did not change keep their lines, comments included. A text
that reads back as anything else than what was to be written is written anew as a whole.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import yaml

from studio.description.poses.named_poses import JOINT_LIMIT, NAME_LIMIT, NamedPose, position_of
from studio.description.syntax.yaml_text import yaml_bytes
from studio.errors import EditError, PosesFileError

if TYPE_CHECKING:
    from collections.abc import Sequence

SIZE_LIMIT_BYTES: Final = 1 << 20
POSE_LIMIT: Final = 200
_DEPTH_LIMIT: Final = 6
_EVENT_LIMIT: Final = 200_000
_VERSION: Final = "1"
_DIGITS: Final = 9
"""Behind the point: a nanometre."""
_LOADER: Final = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_HEAD: Final = (
    "# Poses of {entry}: named joint positions, rad or m.\n"
    "# Written by the studio; edit it as you like.\n"
    f"version: {_VERSION}\n"
    "poses:\n"
)


@dataclass(frozen=True, slots=True)
class _Item:
    """One pose of a file and its lines [start, end) there."""

    pose: NamedPose
    start: int
    end: int


def rounded(position: float) -> float:
    """A position as the file holds it."""
    return round(position, _DIGITS) + 0.0  # never -0


def read_poses(path: str, data: bytes) -> tuple[NamedPose, ...]:
    """The poses of a file, in its order; an empty file has none.

    Raises:
        PosesFileError: It is no YAML, too large, or says something that no pose can.
    """
    return tuple(item.pose for item in _Reading(path, data).items())


def write_poses(path: str, entry: str, before: bytes, poses: Sequence[NamedPose]) -> bytes:
    """The bytes of a file with these poses, as much as can be as it was.

    Args:
        path: Where the file lies, for the words of errors.
        entry: Name of the entry file, told in a new file's first line.
        before: The file as it is; empty for none.
        poses: All of them, in order; their positions `rounded`.

    Raises:
        PosesFileError: The file as it is cannot be read, or what was written could not be.
    """
    written = _woven(path, before, poses) if before.strip() and poses else None
    if written is None or not _says(path, written, poses):
        head = _HEAD.format(entry=entry.replace("\n", " "))
        written = (head + "".join(map(_text, poses))).encode("utf-8", "replace")
    if len(written) > SIZE_LIMIT_BYTES:
        raise PosesFileError(path, "the poses are too many for one file; delete some")
    if not _says(path, written, poses):
        raise PosesFileError(path, "a name in it is one that a file cannot hold; choose another")
    return written


def _says(path: str, written: bytes, poses: Sequence[NamedPose]) -> bool:
    try:
        found = read_poses(path, written)
    except PosesFileError:
        return False
    return [(one.name, one.positions) for one in found] == [
        (one.name, one.positions) for one in poses
    ]


def _woven(path: str, before: bytes, poses: Sequence[NamedPose]) -> bytes | None:
    """The file with the lines of each pose in their order; None when it has none to keep."""
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
    """The lines of each pose, with the comments above it after the pose before."""
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
        return '""'  # which does not read back as it was, and so is told


def _number(value: float) -> str:
    return f"{value:.{_DIGITS}f}".rstrip("0").rstrip(".")


class _Reading:
    """One look at a file; every fault names its line."""

    def __init__(self, path: str, data: bytes) -> None:
        self._path, self._data = path, data

    def items(self) -> tuple[_Item, ...]:
        root = self._root()
        if root is None:
            return ()
        top = self._mapping(root, {"version", "poses"})
        if "version" in top and self._text(top["version"]) != _VERSION:
            raise self._fault(top["version"], "is of another version of the studio")
        listed = top.get("poses")
        if listed is None or _is_null(listed):
            return ()
        if not isinstance(listed, yaml.SequenceNode):
            raise self._fault(listed, "must be a list of poses")
        if len(listed.value) > POSE_LIMIT:
            raise self._fault(listed, f"holds more than {POSE_LIMIT} poses")
        items = tuple(self._item(node) for node in listed.value)
        self._refuse_twins(listed, [item.pose.name for item in items])
        return items

    def _root(self) -> yaml.Node | None:
        """The parsed file; nothing in it is followed, repeated or constructed."""
        if len(self._data) > SIZE_LIMIT_BYTES:
            raise PosesFileError(self._path, f"it is larger than {SIZE_LIMIT_BYTES >> 20} MB")
        try:
            text = self._data.decode("utf-8-sig")
            self._survey(text)
            return yaml.compose(text, _LOADER)
        except UnicodeDecodeError as error:
            raise PosesFileError(self._path, "it is not UTF-8 text") from error
        except yaml.YAMLError as error:
            raise PosesFileError(self._path, f"it is no YAML ({_yaml_words(error)})") from error

    def _survey(self, text: str) -> None:
        """Refuse what a list of poses has no use for, before anything is made of it."""
        depth = 0
        for count, event in enumerate(yaml.parse(text, _LOADER)):
            depth += isinstance(event, yaml.CollectionStartEvent)
            depth -= isinstance(event, yaml.CollectionEndEvent)
            if depth > _DEPTH_LIMIT or count > _EVENT_LIMIT:
                raise self._fault(event, "is nested too deeply or too long")
            if getattr(event, "anchor", None) or getattr(event, "tag", None) not in (None, "!"):
                raise self._fault(event, "has an anchor, alias or tag, which no pose needs")

    def _item(self, node: yaml.Node) -> _Item:
        keys = self._mapping(node, {"name", "joints"})
        if "name" not in keys or "joints" not in keys:
            raise self._fault(node, "is a pose without a name or without joints")
        name = self._text(keys["name"]).strip()
        if not name or len(name) > NAME_LIMIT:
            raise self._fault(keys["name"], f"is no name of up to {NAME_LIMIT} letters")
        joints = self._mapping(keys["joints"], None)
        positions = {joint: self._position(value) for joint, value in joints.items()}
        line = node.start_mark.line
        return _Item(
            NamedPose(name, positions, file=self._path, line=line + 1), line, _last_line(node) + 1
        )

    def _position(self, node: yaml.Node) -> float:
        value = position_of(self._text(node))
        if value is None:
            raise self._fault(node, "is no position in rad or m")
        return rounded(value)

    def _mapping(self, node: yaml.Node, allowed: set[str] | None) -> dict[str, yaml.Node]:
        """The values by key; `allowed` None: any keys."""
        if not isinstance(node, yaml.MappingNode) or len(node.value) > JOINT_LIMIT:
            raise self._fault(node, "must be keys with values")
        pairs = [(self._text(key), value) for key, value in node.value]
        self._refuse_twins(node, [key for key, _ in pairs])
        unknown = [key for key, _ in pairs if allowed is not None and key not in allowed]
        if unknown:
            raise self._fault(node, f'has the unknown key "{unknown[0]}"')
        return dict(pairs)

    def _text(self, node: yaml.Node) -> str:
        if not isinstance(node, yaml.ScalarNode) or len(node.value) > 1_000:
            raise self._fault(node, "must be one short text")
        return str(node.value)

    def _refuse_twins(self, node: yaml.Node, names: Sequence[str]) -> None:
        seen: set[str] = set()
        for name in names:
            if name in seen:
                raise self._fault(node, f'has "{name}" twice')
            seen.add(name)

    def _fault(self, where: yaml.Node | yaml.Event, reason: str) -> PosesFileError:
        line = where.start_mark.line + 1 if where.start_mark else 1
        return PosesFileError(self._path, f"line {line} {reason}")


def _is_null(node: yaml.Node) -> bool:
    return isinstance(node, yaml.ScalarNode) and node.tag == "tag:yaml.org,2002:null"


def _last_line(node: yaml.Node) -> int:
    """The last line that a node has content on; a mapping's own end lies behind its comments."""
    if isinstance(node, yaml.MappingNode) and node.value and not node.flow_style:
        return max(_last_line(part) for pair in node.value for part in pair)
    end = node.end_mark
    return end.line - (end.column == 0 and end.line > node.start_mark.line)


def _yaml_words(error: yaml.YAMLError) -> str:
    mark = getattr(error, "problem_mark", None)
    problem = getattr(error, "problem", None) or "it cannot be parsed"
    return f"line {mark.line + 1}: {problem}" if mark else str(problem)
