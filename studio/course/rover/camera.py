"""Camera: a small picture of the room from where the rover stands."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from studio.course.rover.room import POSTS_M, WALLS_M, cast_rays

if TYPE_CHECKING:
    from numpy.typing import NDArray

WIDTH_PX, HEIGHT_PX = 160, 120
FOCAL_PX = 140.0
"""Both focal lengths; the middle of the picture is its principal point."""
EYE_M, WALL_M = 0.55, 1.3
"""Heights of the camera, and of the walls."""
_FAR_M = 9.0
_WALL_COLORS = np.array(
    [[214, 206, 190], [198, 180, 158], [176, 190, 196], [186, 170, 188]], dtype=np.float64
)
_POST_COLOR = np.array([222, 120, 60], dtype=np.float64)
_SKY = np.array([[228, 234, 240]], dtype=np.float64)
_FLOOR_NEAR, _FLOOR_FAR = np.array([96.0, 88.0, 78.0]), np.array([150.0, 142.0, 132.0])


def intrinsics() -> tuple[float, float, float, float]:
    """Focal lengths fx, fy and principal point cx, cy, pixels."""
    return FOCAL_PX, FOCAL_PX, (WIDTH_PX - 1) / 2, (HEIGHT_PX - 1) / 2


def picture(x: float, y: float, yaw: float) -> NDArray[np.uint8]:
    """Draw what a camera at a place in the room sees, shape (HEIGHT_PX, WIDTH_PX, 3), RGB."""
    beside = (np.arange(WIDTH_PX) - (WIDTH_PX - 1) / 2) / FOCAL_PX
    distances, hits = cast_rays(x, y, yaw - np.arctan(beside))
    depths = np.clip(distances * np.cos(np.arctan(beside)), 0.05, _FAR_M)
    middle = (HEIGHT_PX - 1) / 2
    top = middle - FOCAL_PX * (WALL_M - EYE_M) / depths
    bottom = middle + FOCAL_PX * EYE_M / depths
    rows = np.arange(HEIGHT_PX)[:, None]
    walls = (rows >= top) & (rows <= bottom)
    seen = np.where(walls[..., None], _wall_colors(hits, depths)[None], _ground(rows))
    return seen.astype(np.uint8)


def _wall_colors(hits: NDArray[np.intp], depths: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return shape (WIDTH_PX, 3): each wall has its paint, and is paler where it is far."""
    known = np.concatenate(
        [
            _WALL_COLORS[np.arange(len(WALLS_M)) % len(_WALL_COLORS)],
            np.tile(_POST_COLOR, (len(POSTS_M), 1)),
        ]
    )
    light = 1.0 - 0.55 * np.sqrt(depths / _FAR_M)
    return known[hits] * light[:, None]


def _ground(rows: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return shape (HEIGHT_PX, 1, 3): sky above the horizon, floor that pales towards it."""
    middle = (HEIGHT_PX - 1) / 2
    near = np.clip((rows - middle) / middle, 0.0, 1.0)[..., None]
    floor = _FLOOR_FAR + (_FLOOR_NEAR - _FLOOR_FAR) * np.sqrt(near)
    return np.where((rows < middle)[..., None], _SKY, floor)


def field_of_view_rad() -> float:
    """Return the horizontal angle of view."""
    return 2 * math.atan(WIDTH_PX / 2 / FOCAL_PX)
