"""The room of the rover: walls and posts, how far they are, and their map."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

WIDTH_M, DEPTH_M = 10.0, 8.0
MAP_CELL_M = 0.05
_MAP_MARGIN_M = 0.5
_FREE, _TAKEN, _UNKNOWN = 0, 100, -1

WALLS_M: Floats = np.array(
    [
        # The outer walls, with a niche in the north
        [-5.0, -4.0, 5.0, -4.0], [5.0, -4.0, 5.0, 4.0], [5.0, 4.0, 1.5, 4.0],
        [1.5, 4.0, 1.5, 3.3], [1.5, 3.3, -1.5, 3.3], [-1.5, 3.3, -1.5, 4.0],
        [-1.5, 4.0, -5.0, 4.0], [-5.0, 4.0, -5.0, -4.0],
        # A table in the middle, and a shelf that stands in from the west
        [-1.2, -0.6, 1.2, -0.6], [1.2, -0.6, 1.2, 0.6], [1.2, 0.6, -1.2, 0.6],
        [-1.2, 0.6, -1.2, -0.6],
        [-5.0, 0.2, -4.1, 0.2], [-4.1, 0.2, -4.1, -0.2], [-4.1, -0.2, -5.0, -0.2],
    ]
)  # fmt: skip
"""Shape (W, 4): the ends x0 y0 x1 y1 of each wall."""
POSTS_M: Floats = np.array([[3.9, 1.3, 0.18], [3.9, -1.3, 0.18], [-2.4, -3.4, 0.25]])
"""Shape (P, 3): x, y and radius of each round post."""


def cast_rays(x: float, y: float, angles_rad: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Measure distances from a place in given directions.

    Returns:
        How far the nearest wall or post is, metres, inf where none is, and its number (walls
        first, then posts), both of the shape (N,) of `angles_rad`.
    """
    directions = np.stack([np.cos(angles_rad), np.sin(angles_rad)])
    distances = np.concatenate([_to_walls(x, y, directions), _to_posts(x, y, directions)])
    nearest = distances.argmin(axis=0)
    return distances[nearest, np.arange(len(angles_rad))], nearest


def clearance_m(x: float, y: float) -> float:
    """Return the distance of the nearest wall or post in any direction; 0 within a post."""
    starts, spans = WALLS_M[:, :2], WALLS_M[:, 2:] - WALLS_M[:, :2]
    place = np.array([x, y])
    along = ((place - starts) * spans).sum(axis=1) / (spans**2).sum(axis=1)
    nearest = starts + np.clip(along, 0.0, 1.0)[:, None] * spans
    to_walls = np.hypot(*(place - nearest).T).min()
    to_posts = (np.hypot(*(place - POSTS_M[:, :2]).T) - POSTS_M[:, 2]).min()
    return max(0.0, float(min(to_walls, to_posts)))


def occupancy() -> tuple[NDArray[np.int8], float, float]:
    """Draw the map: cells of `MAP_CELL_M`, shape (rows, columns), and the origin x, y in metres.

    Row 0 is the lowest y. 0 is free, 100 is taken, -1 is not known.
    """
    x0, y0 = -WIDTH_M / 2 - _MAP_MARGIN_M, -DEPTH_M / 2 - _MAP_MARGIN_M
    columns = round((WIDTH_M + 2 * _MAP_MARGIN_M) / MAP_CELL_M)
    rows = round((DEPTH_M + 2 * _MAP_MARGIN_M) / MAP_CELL_M)
    xs = x0 + (np.arange(columns) + 0.5) * MAP_CELL_M
    ys = y0 + (np.arange(rows) + 0.5) * MAP_CELL_M
    near = _near_a_wall(xs, ys)
    inside = (np.abs(xs)[None, :] < WIDTH_M / 2) & (np.abs(ys)[:, None] < DEPTH_M / 2)
    cells = np.where(near, _TAKEN, np.where(inside, _FREE, _UNKNOWN))
    return cells.astype(np.int8), x0, y0


def _to_walls(x: float, y: float, directions: Floats) -> Floats:
    """Return shape (W, N): where each ray meets each wall, inf where it does not."""
    starts, spans = WALLS_M[:, :2], WALLS_M[:, 2:] - WALLS_M[:, :2]
    to_start = starts - np.array([x, y])
    cross = directions[0] * spans[:, 1:] - directions[1] * spans[:, :1]
    with np.errstate(divide="ignore", invalid="ignore"):
        along_ray = (to_start[:, 0] * spans[:, 1] - to_start[:, 1] * spans[:, 0])[:, None] / cross
        along_wall = (to_start[:, :1] * directions[1] - to_start[:, 1:] * directions[0]) / cross
    is_hit = (cross != 0) & (along_ray >= 0) & (along_wall >= 0) & (along_wall <= 1)
    return np.where(is_hit, along_ray, np.inf)


def _to_posts(x: float, y: float, directions: Floats) -> Floats:
    """Return shape (P, N): where each ray enters each post; 0 from within."""
    to_middle = POSTS_M[:, :2] - np.array([x, y])
    ahead = to_middle @ directions
    beside_squared = (to_middle**2).sum(axis=1)[:, None] - ahead**2
    half_squared = POSTS_M[:, 2:] ** 2 - beside_squared
    half = np.sqrt(np.clip(half_squared, 0.0, None))
    is_hit = (half_squared >= 0) & (ahead + half >= 0)
    return np.where(is_hit, np.clip(ahead - half, 0.0, None), np.inf)


def _near_a_wall(xs: NDArray[np.floating], ys: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Return shape (rows, columns): the cells that a wall or post reaches into."""
    half_cell = MAP_CELL_M / 2 + 1e-9  # a wall between two cells takes both
    near = np.zeros((len(ys), len(xs)), dtype=np.bool_)
    for x0, y0, x1, y1 in WALLS_M:
        columns = (xs >= min(x0, x1) - half_cell) & (xs <= max(x0, x1) + half_cell)
        rows = (ys >= min(y0, y1) - half_cell) & (ys <= max(y0, y1) + half_cell)
        near |= rows[:, None] & columns[None, :]
    for x, y, radius in POSTS_M:
        near |= np.hypot(xs[None, :] - x, ys[:, None] - y) <= radius + math.sqrt(2) * half_cell
    return near
