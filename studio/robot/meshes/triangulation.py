"""Polygons, fans and strips to triangles: all at once, but for polygons with a dent."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Integers: TypeAlias = NDArray[np.int64]

_DENTED_LIMIT = 256
"""Corners of a polygon beyond which a dent is not worth the time; such a one stays a fan."""
_DENTED_TOTAL_LIMIT = 10_000


def polygon_corners(sizes: Integers, points: NDArray[np.float32]) -> Integers:
    """Corners of the triangles that cover each polygon, as numbers of its points.

    Args:
        sizes: How many points each polygon takes, in order.
        points: Shape (sum of sizes, 3).
    """
    if not len(sizes) or (int(sizes.max()) == 3 and int(sizes.min()) == 3):
        return np.arange(3 * len(sizes))
    corners = fan_corners(sizes)
    if int(sizes.max()) <= 3:
        return corners
    starts = np.cumsum(sizes) - sizes
    left = _DENTED_TOTAL_LIMIT
    triangle = np.cumsum(np.maximum(sizes - 2, 0)) - np.maximum(sizes - 2, 0)
    for polygon in _dented(sizes, corners, points):
        size, start = int(sizes[polygon]), int(starts[polygon])
        left -= size
        if size > _DENTED_LIMIT or left < 0:
            continue
        first = 3 * int(triangle[polygon])
        cut = _cut_ears(points[start : start + size].astype(np.float64))
        corners[first : first + 3 * (size - 2)] = start + cut
    return corners


def _dented(sizes: Integers, corners: Integers, points: NDArray[np.float32]) -> list[int]:
    """Return polygons of which some triangle of the fan faces the other side than the whole."""
    with np.errstate(over="ignore", invalid="ignore"):  # points at infinity are not drawn
        a, b, c = np.moveaxis(points.astype(np.float64)[corners.reshape(-1, 3)], 1, 0)
        normals = np.cross(b - a, c - a)
        owner = np.repeat(np.arange(len(sizes)), np.maximum(sizes - 2, 0))
        whole = np.stack([np.bincount(owner, column, len(sizes)) for column in normals.T], axis=1)
        along = np.einsum("ij,ij->i", normals, whole[owner])
        dent = along < -1e-9 * np.einsum("ij,ij->i", whole, whole)[owner]
    return sorted(set(owner[dent].tolist()))


def _cut_ears(polygon: NDArray[np.float64]) -> Integers:
    """Triangles of a polygon (N, 3) by cutting one ear after the other, 3 (N - 2) numbers."""
    flat = _flattened(polygon)
    left = list(range(len(flat)))
    cut: list[int] = []
    while len(left) > 3:
        at = next((n for n in range(len(left)) if _is_ear(flat, left, n)), 0)
        cut += (left[at - 1], left[at], left[(at + 1) % len(left)])
        del left[at]
    return np.array([*cut, *left], dtype=np.int64)


def _flattened(polygon: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the polygon in its plane, counter-clockwise, (N, 2)."""
    following = np.roll(polygon, -1, axis=0)
    normal = np.cross(polygon, following).sum(axis=0)
    dropped = int(np.argmax(np.abs(normal)))
    kept = [(dropped + 1) % 3, (dropped + 2) % 3]
    return polygon[:, kept if normal[dropped] >= 0 else kept[::-1]]


def _is_ear(flat: NDArray[np.float64], left: list[int], at: int) -> bool:
    """Whether the corner sticks out and no other one lies in its triangle."""
    a, b, c = flat[left[at - 1]], flat[left[at]], flat[left[(at + 1) % len(left)]]
    if _turn(a, b, c) <= 0:
        return False
    others = flat[left]
    inside = (_turn(a, b, others) >= 0) & (_turn(b, c, others) >= 0) & (_turn(c, a, others) >= 0)
    for corner in (a, b, c):  # itself, or another one at the same place, as bridges to holes have
        inside &= (others != corner).any(axis=1)
    return not bool(np.any(inside))


def _turn(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Twice the area of triangles a, b, c; positive when they turn left. `c` may be many."""
    return (b[0] - a[0]) * (c[..., 1] - a[1]) - (b[1] - a[1]) * (c[..., 0] - a[0])


def fan_corners(sizes: Integers) -> Integers:
    """Corners of the triangles that fan out from the first corner of each polygon."""
    first, second = _within(sizes)
    return np.stack((first, first + second, first + second + 1), axis=1).ravel()


def strip_corners(sizes: Integers) -> Integers:
    """Return the corners of the triangles of strips; every second one is in reverse order."""
    first, second = _within(sizes)
    at = first + second - 1
    odd = second % 2 == 0
    return np.stack((at, at + 1 + odd, at + 2 - odd), axis=1).ravel()


def _within(sizes: Integers) -> tuple[Integers, Integers]:
    """Return for each triangle the first corner of its polygon, and its number there, from 1."""
    triangles = np.maximum(sizes - 2, 0)
    starts = np.cumsum(sizes) - sizes
    before = np.cumsum(triangles) - triangles
    number = np.arange(int(triangles.sum())) - np.repeat(before, triangles) + 1
    return np.repeat(starts, triangles), number
