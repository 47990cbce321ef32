"""Rotations and poses as unit quaternions and as matrices, many at once."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.tf.transforms import Floats

Pose: TypeAlias = tuple[float, float, float, float, float, float, float]
"""w, x, y, z of a unit quaternion, then x, y, z in m."""

IDENTITY: Pose = (1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
_STRAIGHT = 1e-6
"""Sine of an angle below which an arc is its chord."""
_ROWS_AT_ONCE = 1000
"""Times 16 times 16 that are fewer than 2**18 products, which OpenBLAS leaves to one thread."""


def between(before: Floats, after: Floats, shares: Floats) -> Floats:
    """Return poses in between: positions along a line, rotations along the shorter arc.

    Args:
        before: Shape (N, 7), as `Pose`.
        after: Shape (N, 7).
        shares: Shape (N,), 0 at `before` to 1 at `after`.
    """
    mixed = before + shares[:, None] * (after - before)
    mixed[:, :4] = _slerp(before[:, :4], after[:, :4], shares)
    return mixed


def between_two(before: Pose, after: Pose, share: float) -> Pose:
    """Return one pose in between, as `between`: for a few poses a tenth of its time."""
    w, x, y, z, *place = before
    ow, ox, oy, oz, *other = after
    dot = w * ow + x * ox + y * oy + z * oz
    angle = math.acos(min(abs(dot), 1.0))
    if (sine := math.sin(angle)) < _STRAIGHT:
        first, second = 1 - share, share
    else:
        first, second = math.sin((1 - share) * angle) / sine, math.sin(share * angle) / sine
    second = math.copysign(second, dot)
    w, x = first * w + second * ow, first * x + second * ox
    y, z = first * y + second * oy, first * z + second * oz
    px, py, pz = (one + share * (end - one) for one, end in zip(place, other, strict=True))
    return w, x, y, z, px, py, pz


def _slerp(before: Floats, after: Floats, shares: Floats) -> Floats:
    # A quaternion and its negative are one rotation: the nearer of both is the shorter arc.
    dots = np.einsum("ij,ij->i", before, after)
    angles = np.arccos(np.minimum(np.abs(dots), 1.0))
    sines = np.sin(angles)
    straight = sines < _STRAIGHT
    if straight.any():
        # Shares of an arc that is a straight line; an angle and its sine may be anything alike.
        angles[straight] = sines[straight] = 1e-6
    of_before = np.sin((1 - shares) * angles) / sines
    of_after = np.copysign(np.sin(shares * angles) / sines, dots)
    return of_before[:, None] * before + of_after[:, None] * after


def matrices_from_poses(poses: Floats) -> Floats:
    """Homogeneous matrices, shape (N, 4, 4), of poses (N, 7)."""
    quaternions = poses[:, :4]
    products = (quaternions[:, :, None] * quaternions[:, None, :]).reshape(-1, 16)
    matrices = _product(products, _ENTRY_OF_PRODUCTS).reshape(-1, 4, 4)
    matrices[:, :3, 3] = poses[:, 4:]
    return matrices


def poses_from_matrices(matrices: Floats) -> Floats:
    """Poses, shape (N, 7), of homogeneous matrices (N, 4, 4) without scale."""
    poses = np.empty((len(matrices), 7))
    poses[:, :4] = quaternions_from_matrices(matrices)
    poses[:, 4:] = matrices[:, :3, 3]
    return poses


def _product(rows: Floats, table: Floats) -> Floats:
    """Multiply many rows with a small matrix, in the calling thread.

    Of more rows at once numpy's library starts threads, and on a busy machine they wait for one
    another: five times as long, and more than that of all processors.
    """
    product = np.empty((len(rows), table.shape[1]))
    for begin in range(0, len(rows), _ROWS_AT_ONCE):
        some = slice(begin, begin + _ROWS_AT_ONCE)
        np.matmul(rows[some], table, out=product[some])
    return product


def _entries_of_products() -> Floats:
    """Return what each product of two parts of a quaternion adds to each entry of its matrix.

    Shape (16, 16): products ww, wx, wy ... zz, and entries of a matrix (4, 4) row by row. The last
    entry is the squared length, which is 1.
    """
    entries = np.zeros((4, 4, 4, 4))
    for axis in range(3):
        one, other, third = 1 + axis, 1 + (axis + 1) % 3, 1 + (axis + 2) % 3
        entries[[0, one, other, third], [0, one, other, third], axis, axis] = 1, 1, -1, -1
        entries[one, other, [one - 1, other - 1], [other - 1, one - 1]] = 2
        entries[0, third, [one - 1, other - 1], [other - 1, one - 1]] = -2, 2
        entries[one, one, 3, 3] = 1
    entries[0, 0, 3, 3] = 1
    return entries.reshape(16, 16)


def _products_of_entries() -> tuple[Floats, Floats]:
    """Return what each entry of a rotation matrix adds to 4 times each product of two parts.

    Shape (9, 16): entries row by row, and products ww, wx, wy ... zz; and (16,): what is added.
    """
    products = np.zeros((3, 3, 4, 4))
    for axis in range(3):
        one, other, third = 1 + axis, 1 + (axis + 1) % 3, 1 + (axis + 2) % 3
        products[axis, axis, [0, one, other, third], [0, one, other, third]] = 1, 1, -1, -1
        for first, second in ((one, other), (other, one)):
            products[[one - 1, other - 1], [other - 1, one - 1], first, second] = 1
        for first, second in ((0, third), (third, 0)):
            products[[one - 1, other - 1], [other - 1, one - 1], first, second] = -1, 1
    return products.reshape(9, 16), np.eye(4).reshape(16)


_ENTRY_OF_PRODUCTS = _entries_of_products()
_PRODUCT_OF_ENTRIES, _PRODUCT_OF_NOTHING = _products_of_entries()


def quaternions_from_matrices(matrices: Floats) -> Floats:
    """Unit quaternions (N, 4) of rotations (N, 3, 3), or of matrices that begin with them.

    Of the products of all parts, each is the row of its largest part.
    """
    entries = matrices[:, :3, :3].reshape(-1, 9)
    products = _product(entries, _PRODUCT_OF_ENTRIES) + _PRODUCT_OF_NOTHING
    products = products.reshape(-1, 4, 4)
    every, largest = np.arange(len(products)), np.einsum("nii->ni", products).argmax(axis=1)
    rows = products[every, largest]
    # That row is 4 times the part times all parts.
    return rows * (0.5 / np.sqrt(rows[every, largest]))[:, None]


def inverse_of(a_from_b: Floats) -> Floats:
    """Return the inverse of a homogeneous matrix (4, 4) without scale."""
    b_from_a = np.eye(4)
    b_from_a[:3, :3] = a_from_b[:3, :3].T
    b_from_a[:3, 3] = -b_from_a[:3, :3] @ a_from_b[:3, 3]
    return b_from_a


def compose(a_from_b: Pose, b_from_c: Pose) -> Pose:
    """Return the pose of c in a."""
    w, x, y, z, px, py, pz = a_from_b
    ow, ox, oy, oz, qx, qy, qz = b_from_c
    rx, ry, rz = turned(a_from_b, qx, qy, qz)
    return (
        w * ow - x * ox - y * oy - z * oz,
        w * ox + x * ow + y * oz - z * oy,
        w * oy - x * oz + y * ow + z * ox,
        w * oz + x * oy - y * ox + z * ow,
        px + rx,
        py + ry,
        pz + rz,
    )


def inverse(a_from_b: Pose) -> Pose:
    """Return the pose of a in b."""
    w, x, y, z, px, py, pz = a_from_b
    back: Pose = (w, -x, -y, -z, 0.0, 0.0, 0.0)
    rx, ry, rz = turned(back, px, py, pz)
    return (w, -x, -y, -z, -rx, -ry, -rz)


def wxyz_from_rpy(roll: float, pitch: float, yaw: float) -> tuple[float, float, float, float]:
    """Return the unit quaternion of turns in rad about the fixed axes x, then y, then z."""
    cr, sr = math.cos(roll / 2), math.sin(roll / 2)
    cp, sp = math.cos(pitch / 2), math.sin(pitch / 2)
    cy, sy = math.cos(yaw / 2), math.sin(yaw / 2)
    return (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )


def turned(turn: Sequence[float], x: float, y: float, z: float) -> tuple[float, float, float]:
    """Return a point turned about the origin by the unit quaternion that `turn` begins with."""
    w, i, j, k = turn[:4]
    cx, cy, cz = 2 * (j * z - k * y), 2 * (k * x - i * z), 2 * (i * y - j * x)
    return (
        x + w * cx + j * cz - k * cy,
        y + w * cy + k * cx - i * cz,
        z + w * cz + i * cy - j * cx,
    )
