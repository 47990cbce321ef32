"""Corners to vertices: equal corners become one vertex, normals are smoothed up to creases."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.meshes.surfaces import Floats, Surface

_CREASE_COSINE = math.cos(math.radians(40.0))
_MIX = np.uint64(0x9E3779B97F4A7C15)


@dataclass(frozen=True, slots=True, eq=False)
class Welded:
    """Indexed triangles; row i of every array belongs to vertex i."""

    vertices: Floats
    faces: NDArray[np.uint32]
    normals: Floats
    uv: Floats | None
    colors: NDArray[np.uint8] | None


def weld(surface: Surface) -> Welded:
    """Share equal corners; without normals in the file, smooth them up to edges of 40 degrees."""
    normals, group = surface.normals, None
    if normals is None or not np.isfinite(normals).all():
        normals, group = crease_normals(surface.positions)
    if group is not None and surface.uv is None and surface.colors is None:
        first, vertex_of_corner = _number_labels(group)
    else:
        first, vertex_of_corner = weld_rows(_rows(surface, normals))
    return Welded(
        surface.positions[first],
        vertex_of_corner.astype(np.uint32).reshape(-1, 3),
        normals[first],
        None if surface.uv is None else surface.uv[first],
        None if surface.colors is None else surface.colors[first],
    )


def _rows(surface: Surface, normals: Floats) -> Floats:
    """Return all that makes a corner, side by side; colours by their bits."""
    rows = [surface.positions, normals]
    if surface.uv is not None:
        rows.append(surface.uv)
    if surface.colors is not None:
        rows.append(np.ascontiguousarray(surface.colors).view(np.float32))
    return np.concatenate(rows, axis=1)


def _number_labels(label: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return as `weld_rows`, for labels that are each the index of their first occurrence."""
    is_first = label == np.arange(len(label))
    return np.flatnonzero(is_first), (np.cumsum(is_first) - 1)[label]


def weld_rows(rows: Floats) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Number equal rows alike, in order of first appearance.

    Sorts 64-bit hashes, which is several times faster than sorting rows, and checks the outcome.

    Returns:
        For each distinct row the index where it first stands; for each row its number.
    """
    bits = np.ascontiguousarray(rows, dtype=np.float32).view(np.uint32)
    bits = np.where(bits == np.uint32(0x80000000), np.uint32(0), bits)  # -0.0 is 0.0
    first, number = _number_equal(_hash_rows(bits))
    if not np.array_equal(bits[first][number], bits):  # two rows of one hash
        _, first, number = np.unique(bits, axis=0, return_index=True, return_inverse=True)
        number = number.ravel()
    return _by_first_appearance(first, number)


def _hash_rows(bits: NDArray[np.uint32]) -> NDArray[np.uint64]:
    hashed = np.zeros(len(bits), dtype=np.uint64)
    for column in bits.T:
        hashed = (hashed ^ column) * _MIX
        hashed ^= hashed >> np.uint64(29)
    return hashed


def _number_equal(keys: NDArray[np.uint64]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    order = np.argsort(keys)
    ordered = keys[order]
    starts = np.empty(len(keys), dtype=np.bool_)
    starts[:1] = True
    np.not_equal(ordered[1:], ordered[:-1], out=starts[1:])
    number = np.empty(len(keys), dtype=np.intp)
    number[order] = np.cumsum(starts) - 1
    return np.minimum.reduceat(order, np.flatnonzero(starts)), number


def _by_first_appearance(
    first: NDArray[np.intp], number: NDArray[np.intp]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Renumber so that neighbours in the file are neighbours in memory."""
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return first[order], rank[number]


def crease_normals(positions: Floats) -> tuple[Floats, NDArray[np.intp]]:
    """Return each corner's unit normal: the mean over faces that meet there without a crease.

    And for each corner the first corner that it shares both point and normal with.

    Args:
        positions: Corners, (3 M, 3). A triangle without area has the normal zero of its own, and
            takes that of its neighbours where they are smooth.
    """
    _, point = weld_rows(positions)
    face_normals = _area_normals(positions)
    group = _smooth_groups(point, face_normals)
    weights = np.repeat(face_normals, 3, axis=0)
    summed = np.stack([np.bincount(group, weights=column) for column in weights.T], axis=1)[group]
    lengths = np.linalg.norm(summed, axis=1, keepdims=True)
    return (summed / np.where(lengths > 0, lengths, 1.0)).astype(np.float32), group


def _area_normals(positions: Floats) -> NDArray[np.float64]:
    """Normal of each triangle, as long as twice its area."""
    a, b, c = np.moveaxis(positions.reshape(-1, 3, 3).astype(np.float64), 1, 0)
    return np.cross(b - a, c - a)


def _smooth_groups(point: NDArray[np.intp], face_normals: NDArray[np.float64]) -> NDArray[np.intp]:
    """Number the corners so that those with one number share a point and no crease parts them."""
    lengths = np.linalg.norm(face_normals, axis=1, keepdims=True)
    unit = face_normals / np.where(lengths > 0, lengths, 1.0)
    one, other = _edges_in_common(point)
    smooth = np.einsum("ij,ij->i", unit[one // 3], unit[other // 3]) > _CREASE_COSINE
    one, other = one[smooth], other[smooth]
    one_end, other_end = _next_corner(one), _next_corner(other)
    straight = point[one] == point[other]  # else the two faces use the edge in opposite directions
    left = np.concatenate((one, one_end))
    right = np.concatenate(
        (np.where(straight, other, other_end), np.where(straight, other_end, other))
    )
    return _connected(len(point), left, right)


def _edges_in_common(point: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of corners whose edges, each to the next corner of its face, are the same edge."""
    end = point[_next_corner(np.arange(len(point)))]
    key = np.minimum(point, end) * (len(point) + 1) + np.maximum(point, end)
    order = np.argsort(key)
    same = key[order[1:]] == key[order[:-1]]
    return order[:-1][same], order[1:][same]


def _next_corner(corner: NDArray[np.intp]) -> NDArray[np.intp]:
    return np.where(corner % 3 == 2, corner - 2, corner + 1)


def _connected(count: int, left: NDArray[np.intp], right: NDArray[np.intp]) -> NDArray[np.intp]:
    """Number the connected parts of a graph of `count` nodes by their least node."""
    label = np.arange(count)
    while len(left):
        lower = np.minimum(label[left], label[right])
        np.minimum.at(label, label[left], lower)
        np.minimum.at(label, label[right], lower)
        while not np.array_equal(jumped := label[label], label):
            label = jumped
        apart = label[left] != label[right]
        left, right = left[apart], right[apart]
    return label
