"""Files of initial positions: one map from joint to position, bare or under `initial_positions`.

Source: `config/initial_positions.yaml` as MoveIt's setup assistant and the descriptions of
Universal Robots write it. xacro's units (`!degrees 90`) hold here too.
"""

from __future__ import annotations

from pathlib import PurePath
from typing import Final, cast

from studio.description.faults import Fault
from studio.description.poses.named_poses import JOINT_LIMIT, NAME_LIMIT, NamedPose, position_of
from studio.description.syntax.yaml_reading import read_yaml

SIZE_LIMIT_BYTES: Final = 1 << 18
_KEY: Final = "initial_positions"


def initial_positions(path: str, data: bytes) -> NamedPose | None:
    """The pose of a file; None when it is no map of joints to numbers, whatever else it may be."""
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
