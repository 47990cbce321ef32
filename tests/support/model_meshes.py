"""Writes the meshes of the shipped models: `python -m tests.support.model_meshes`.

Each mesh has its size in the name of its function or is of unit size, to be scaled by the xacro.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tests.support.solids import (
    Painted,
    Solid,
    box,
    loft,
    placed,
    rounded_rectangle,
    turned,
    write_dae,
    write_glb,
    write_stl,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

MODELS = Path(__file__).resolve().parents[2] / "models"

GREY = (0.62, 0.65, 0.69)
DARK = (0.16, 0.17, 0.20)
BLUE = (0.16, 0.45, 0.78)
ORANGE = (0.93, 0.49, 0.13)
WHITE = (0.90, 0.91, 0.93)


def tyre() -> Solid:
    """A tyre of radius 1 and width 1 about z: rounded shoulders and 2 x 18 slanted lugs."""
    carcass = turned(
        [
            (0.52, -0.44),
            (0.62, -0.5),
            (0.84, -0.5),
            (0.91, -0.42),
            (0.94, -0.22),
            (0.94, 0.22),
            (0.91, 0.42),
            (0.84, 0.5),
            (0.62, 0.5),
            (0.52, 0.44),
        ],
        32,
    )
    return np.concatenate([carcass, *(_lug(n, side) for n in range(18) for side in (-1, 1))])


def _lug(number: int, side: int) -> Solid:
    """One block of the tread; the two sides are half a pitch apart, both slant outwards."""
    middle = 2 * math.pi / 18 * (number + (0.5 if side > 0 else 0.0))
    inner, outer = _lug_ring(middle, 0.03 * side, 1.0), _lug_ring(middle + 0.10, 0.47 * side, 0.955)
    return loft([inner, outer] if side > 0 else [outer, inner])


def _lug_ring(middle_rad: float, z: float, top: float) -> NDArray[np.float64]:
    """The cut through a lug at height z: from inside the carcass up to `top`."""
    half = 0.085
    corners = [
        (0.88, middle_rad - half),
        (top, middle_rad - 0.8 * half),
        (top, middle_rad + 0.8 * half),
        (0.88, middle_rad + half),
    ]
    return np.array([(r * math.cos(turn), r * math.sin(turn), z) for r, turn in corners])


def hull() -> Solid:
    """A rover's body of size 1 x 1 x 1 about the origin: keel drawn in, corners cut."""
    return loft(
        [
            rounded_rectangle((0.76, 0.70), 0.06, -0.5),
            rounded_rectangle((0.98, 0.96), 0.07, -0.10),
            rounded_rectangle((1.00, 1.00), 0.07, 0.06),
            rounded_rectangle((1.00, 1.00), 0.07, 0.34),
            rounded_rectangle((0.95, 0.93), 0.07, 0.5),
        ]
    )


def arm_base() -> Solid:
    """A foot of radius 1 and height 1, its underside at z = 0."""
    return turned([(1.0, 0.0), (1.0, 0.16), (0.80, 0.30), (0.74, 0.34), (0.74, 0.94), (0.70, 1.0)])


def arm_bone() -> Solid:
    """A bone of radius 1 and length 1 along z from 0: slim in the middle."""
    return turned(
        [
            (0.80, 0.0),
            (0.92, 0.06),
            (0.92, 0.16),
            (0.68, 0.30),
            (0.62, 0.5),
            (0.68, 0.70),
            (0.92, 0.84),
            (0.92, 0.94),
            (0.80, 1.0),
        ],
        28,
    )


def arm_joint() -> list[Painted]:
    """A drive of radius 1 and length 2 about y: grey drum, blue caps, a dark seam."""
    lying = (math.pi / 2, 0.0, 0.0)
    drum = placed(turned([(0.94, -0.78), (1.0, -0.70), (1.0, 0.70), (0.94, 0.78)]), rpy=lying)
    seam = placed(turned([(1.02, -0.06), (1.02, 0.06)]), rpy=lying)
    left = turned([(0.94, 0.78), (0.94, 0.92), (0.84, 1.0)])
    caps = np.concatenate([placed(left, rpy=lying), placed(left, rpy=(-math.pi / 2, 0.0, 0.0))])
    return [Painted("drum", drum, GREY), Painted("caps", caps, BLUE), Painted("seam", seam, DARK)]


def arm_flange() -> list[Painted]:
    """A wrist of radius 1 and length 1 along z from 0, with a tool plate and four bolts."""
    body = turned([(0.86, 0.0), (1.0, 0.10), (1.0, 0.62), (0.90, 0.72)])
    plate = turned([(0.90, 0.72), (0.90, 0.94), (0.84, 1.0)])
    bolt = turned([(0.10, 0.98), (0.10, 1.05)], 8)
    bolts = [placed(bolt, (0.6 * x, 0.6 * y, 0.0)) for x, y in ((1, 0), (0, 1), (-1, 0), (0, -1))]
    mark = box((0.80, -0.12, 0.20), (1.04, 0.12, 0.54))
    return [
        Painted("body", body, GREY),
        Painted("plate", plate, WHITE),
        Painted("bolts", np.concatenate(bolts), DARK),
        Painted("mark", mark, ORANGE),
    ]


def dome() -> Solid:
    """The upper half of a ball of radius 1, its rim at z = 0."""
    steps = np.linspace(0.0, math.pi / 2, 9)[:-1]
    return turned([(math.cos(a), math.sin(a)) for a in steps] + [(0.05, 1.0)])


def drum() -> list[Painted]:
    """The astromech's body, radius 1, z from -1 to 1: white with blue panels and dark bands."""
    shell = turned([(0.80, -1.0), (0.98, -0.82), (1.0, -0.78), (1.0, 0.94), (0.97, 1.0)], 48)
    bands = [turned([(1.012, z), (1.012, z + 0.06)], 48) for z in (-0.72, 0.80)]
    panels = [
        placed(box((0.90, -w, low), (1.02, w, high)), rpy=(0, 0, turn))
        for turn, w, low, high in (
            (0.0, 0.20, 0.10, 0.62),
            (0.62, 0.15, -0.10, 0.62),
            (-0.62, 0.15, -0.10, 0.62),
            (math.pi, 0.24, -0.40, 0.50),
            (2.4, 0.14, 0.0, 0.62),
            (-2.4, 0.14, 0.0, 0.62),
        )
    ]
    vents = [box((0.90, -0.18, z), (1.03, 0.18, z + 0.07)) for z in (-0.52, -0.36, -0.20)]
    return [
        Painted("shell", shell, WHITE),
        Painted("panels", np.concatenate(panels), BLUE),
        Painted("dark", np.concatenate([*bands, *vents]), DARK),
    ]


STL: Mapping[str, Callable[[], Solid]] = {
    "rover_description/meshes/tyre.stl": tyre,
    "rover_description/meshes/hull.stl": hull,
    "arm6_description/meshes/base.stl": arm_base,
    "arm6_description/meshes/bone.stl": arm_bone,
    "r2d2_description/meshes/dome.stl": dome,
}
DAE: Mapping[str, Callable[[], list[Painted]]] = {
    "arm6_description/meshes/joint.dae": arm_joint,
    "r2d2_description/meshes/body.dae": drum,
}
GLB: Mapping[str, Callable[[], list[Painted]]] = {
    "arm6_description/meshes/flange.glb": arm_flange,
}


def write_all(models: Path) -> list[Path]:
    """Write every mesh below `models` and name them."""
    for name in (*STL, *DAE, *GLB):
        (models / name).parent.mkdir(parents=True, exist_ok=True)
    for name, make in STL.items():
        write_stl(models / name, make())
    for name, paint in DAE.items():
        write_dae(models / name, paint())
    for name, paint in GLB.items():
        write_glb(models / name, paint())
    return [models / name for name in (*STL, *DAE, *GLB)]


if __name__ == "__main__":
    write_all(MODELS)
