"""Turning: quaternions of many poses at once, vectors turned by them, and what can be drawn."""

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
    """Which rows (N, K) hold only numbers that can be drawn; shape (N,)."""
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
    axes = wxyz[:, 1:]
    vectors = np.broadcast_to(vectors, axes.shape)
    across = 2.0 * np.cross(axes, vectors)
    return vectors + wxyz[:, :1] * across + np.cross(axes, across)


def product(one: Floats, other: Floats) -> Floats:
    """The turn `other` followed by `one`, both unit quaternions (4,)."""
    w = one[0] * other[0] - one[1:] @ other[1:]
    axis = one[0] * other[1:] + other[0] * one[1:] + np.cross(one[1:], other[1:])
    return np.concatenate(([w], axis))


def shortest_turn(start: Floats, end: Floats) -> Floats:
    """The unit quaternion (4,) that turns one direction (3,) to another on the shortest way.

    Directions have length 1; opposite ones are half a turn about an axis across.
    """
    w = 1.0 + start @ end
    if w < 1e-12:
        across = np.cross(start, np.eye(3)[int(np.argmin(np.abs(start)))])
        return np.concatenate(([0.0], across / np.linalg.norm(across)))
    made = np.concatenate(([w], np.cross(start, end)))
    return made / np.linalg.norm(made)


def angle_between_rad(one: Floats, other: Floats) -> float:
    """How far two attitudes (4,) are apart, 0 to pi."""
    return float(2.0 * np.arccos(min(1.0, abs(float(one @ other)))))
