"""Arrows as nodes: all at once, but for those that are shorter than their head."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from viser import _messages

from studio.displays.drawing import Solids
from studio.scene.many_nodes import linear, many_of
from studio.scene.node import Node

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import Arrows

_SHORTEST_M = 1e-6


def arrows_of(shape: Arrows, stream: str) -> dict[str, Node]:
    """Whole arrows, and for short ones a head that is smaller in all its sizes."""
    with np.errstate(invalid="ignore"):
        along: NDArray[np.float32] = shape.ends[:, 1] - shape.ends[:, 0]
    lengths_m: NDArray[np.float32] = np.linalg.norm(along, axis=1)
    lengths_m[~np.isfinite(lengths_m)] = 0  # from nowhere or to nowhere: not drawn
    whole = lengths_m >= max(shape.head_length_m, _SHORTEST_M)
    short = (lengths_m > _SHORTEST_M) & ~whole
    nodes: dict[str, Node] = {}
    if whole.any():
        nodes["arrows"] = _whole(shape, whole, stream)
    if short.any():
        nodes.update(many_of(_heads(shape, along, lengths_m, short), stream))
    return nodes


def _whole(shape: Arrows, which: NDArray[np.bool_], stream: str) -> Node:
    props: dict[str, Any] = {
        "shaft_radius": shape.shaft_diameter_m / 2,
        "head_radius": shape.head_diameter_m / 2,
        "head_length": shape.head_length_m,
        "scale": 1.0,
        "studio_opacity": shape.opacity,
    }
    arrays: dict[str, NDArray[Any]] = {
        "points": np.ascontiguousarray(shape.ends[which], np.float32),
        "colors": linear(_colors_of(shape, which)),
    }
    # Which arrows are whole hangs on the length of their heads.
    name = f"{stream}/{shape.head_length_m}"
    return Node(_messages.ArrowMessage, props, stream=name, flowing=arrays)


def _colors_of(shape: Arrows, which: NDArray[np.bool_]) -> NDArray[np.uint8]:
    return np.ascontiguousarray(shape.colors[which] if shape.colors.ndim > 1 else shape.colors)


def _heads(
    shape: Arrows,
    along: NDArray[np.float32],
    lengths_m: NDArray[np.float32],
    which: NDArray[np.bool_],
) -> Solids:
    long_m = lengths_m[which]
    width_m = shape.head_diameter_m * long_m / shape.head_length_m
    return Solids(
        "cone",
        shape.ends[which, 1],
        _z_turned_to(-along[which] / long_m[:, None]),
        np.stack([width_m, width_m, long_m], axis=1),
        _colors_of(shape, which),
        shape.opacity,
    )


def _z_turned_to(directions: NDArray[np.float32]) -> NDArray[np.float32]:
    """The quaternions that turn z to each direction, shape (N, 3) of length 1, the short way."""
    x, y, z = directions.T
    wxyz = np.stack([1 + z, -y, x, np.zeros_like(x)], axis=1)
    wxyz[z < -1 + 1e-6] = (0, 1, 0, 0)  # straight back: half a turn about x
    return wxyz / np.linalg.norm(wxyz, axis=1, keepdims=True)
