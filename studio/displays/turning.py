"""Rotations of many poses at once by quaternions, and which numbers can be drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"
Flags: TypeAlias = "NDArray[np.bool_]"

FAR: Final = 1e12
"""Numbers beyond it cannot be drawn: their products leave the range of a graphics card."""


def drawable(rows: Floats) -> Flags:
    """Return which rows (N, K) have only numbers that can be drawn; shape (N,)."""
    return np.logical_and.reduce(np.abs(rows) <= FAR, axis=1)


def unit_quaternions(wxyz: Floats) -> tuple[Floats, Flags]:
    """Quaternions (N, 4) at length 1, and which of them had none: those are no turn, as in RViz.

    Finite numbers of any size are taken.
    """
    # Divided by the largest part first: squares of what is very large or small leave the range.
    largest = np.abs(wxyz).max(axis=1, keepdims=True, initial=0.0)
    zero = largest[:, 0] == 0.0
    scaled = wxyz / np.where(largest == 0.0, 1.0, largest)
    scaled[zero, 0] = 1.0
    return scaled / np.linalg.norm(scaled, axis=1, keepdims=True), zero


def turned(wxyz: Floats, vectors: Floats) -> Floats:
    """Vectors (3,) or (N, 3), each turned by a unit quaternion (N, 4); shape (N, 3)."""
    # Part by part: of few vectors, a cross product of numpy would take longer than all of it.
    w, x, y, z = wxyz.T
    to_x, to_y, to_z = vectors.T
    by_x, by_y, by_z = (
        2.0 * (y * to_z - z * to_y), 2.0 * (z * to_x - x * to_z), 2.0 * (x * to_y - y * to_x),
    )  # fmt: skip
    made = np.empty((len(wxyz), 3))
    made[:, 0] = to_x + w * by_x + y * by_z - z * by_y
    made[:, 1] = to_y + w * by_y + z * by_x - x * by_z
    made[:, 2] = to_z + w * by_z + x * by_y - y * by_x
    return made


def product(one: Floats, other: Floats) -> Floats:
    """Return the rotation `other` followed by `one`, unit quaternions (4,) and (..., 4)."""
    w, x, y, z = one
    return other @ np.array([[w, x, y, z], [-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])


def products(one: Floats, other: Floats) -> Floats:
    """Return the turns `other` followed by `one`, unit quaternions (N, 4)."""
    w, x, y, z = one.T
    a, b, c, d = other.T
    return np.stack(
        (
            w * a - x * b - y * c - z * d,
            w * b + x * a + y * d - z * c,
            w * c - x * d + y * a + z * b,
            w * d + x * c - y * b + z * a,
        ),
        axis=1,
    )


def turns_from_z(directions: Floats) -> Floats:
    """Return unit quaternions (N, 4) of the shortest rotations of z to unit vectors (N, 3)."""
    x, y, z = directions.T
    turns = np.stack((1.0 + z, -y, x, np.zeros_like(z)), axis=1)
    turns[z < -1.0 + 1e-12] = (0.0, 1.0, 0.0, 0.0)
    return turns / np.linalg.norm(turns, axis=1, keepdims=True)


def shortest_turn(start: Floats, end: Floats) -> Floats:
    """Return the unit quaternion (4,) of the shortest rotation from one direction (3,) to another.

    Directions have length 1; between opposite ones it is half a turn about a perpendicular axis.
    """
    w = 1.0 + start @ end
    if w < 1e-12:
        across = np.cross(start, np.eye(3)[int(np.argmin(np.abs(start)))])
        return np.concatenate(([0.0], across / np.linalg.norm(across)))
    made = np.concatenate(([w], np.cross(start, end)))
    return made / np.linalg.norm(made)


def angle_between_rad(one: Floats, other: Floats) -> float:
    """Return the angle between two attitudes (4,), 0 to pi."""
    return float(2.0 * np.arccos(min(1.0, abs(float(one @ other)))))
