# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
"""Link poses as yourdfpy computes them: what our kinematics are measured against."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any

import numpy as np
import yourdfpy

if TYPE_CHECKING:
    from collections.abc import Mapping
    from io import BytesIO
    from pathlib import Path

    from numpy.typing import NDArray


def poses_by_yourdfpy(
    urdf: BytesIO, positions: Mapping[str, float]
) -> dict[str, NDArray[np.float64]] | None:
    """Pose of every link at these joint positions; None for a robot that it cannot load."""
    logging.getLogger("yourdfpy").setLevel(logging.CRITICAL)
    try:
        robot: Any = yourdfpy.URDF.load(urdf, load_meshes=False)
    except (KeyError, ValueError):
        return None
    actuated = set(robot.actuated_joint_names)
    robot.update_cfg({name: float(value) for name, value in positions.items() if name in actuated})
    return {
        name: np.asarray(robot.get_transform(name), dtype=np.float64) for name in robot.link_map
    }


def loaded_by_yourdfpy(urdf: Path, joint: str) -> tuple[list[float], int]:
    """Where a joint stands, x y z in m, and how many meshes were read for the robot's visuals."""
    robot: Any = yourdfpy.URDF.load(str(urdf))
    return [float(one) for one in robot.joint_map[joint].origin[:3, 3]], len(robot.scene.geometry)
