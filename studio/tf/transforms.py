"""The transforms of one message as columns, and why some of them cannot be used."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"
Numbers: TypeAlias = "NDArray[np.int64]"
Flags: TypeAlias = "NDArray[np.bool_]"
NAME_LETTERS_MAX: Final = 256
_FAR_M: Final = 1e12
_SQUARED_LENGTH_OFF: Final = 1e-2
"""Largest error of a quaternion; tf2 drops those farther from 1."""
Kind: TypeAlias = Literal[
    "no_name", "long_name", "own_parent", "not_finite", "too_far", "zero_quaternion",
    "no_unit_quaternion", "no_stamp", "circle", "other_parent", "too_deep", "too_many", "too_old",
    "moved", "time_jumped", "and_more",
]  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class TransformColumns:
    """The transforms of one message, in its order; the arrays are read-only.

    Attributes:
        parents: The `header.frame_id` of each.
        children: The `child_frame_id` of each.
        stamps_ns: Shape (N,), int64, since the epoch.
        translations: Shape (N, 3), float64, metres: the child's origin in the parent.
        rotations_wxyz: Shape (N, 4), float64, as sent, of any length.
    """

    parents: tuple[str, ...]
    children: tuple[str, ...]
    stamps_ns: Numbers
    translations: Floats
    rotations_wxyz: Floats


class Notice(NamedTuple):
    """A remark on a transform that was received."""

    kind: Kind
    parent: str
    child: str
    publisher: str
    sentence: str
    left_out: bool = True
    """Whether the transform was left out; else it was taken, and this is worth knowing."""


def plain_name(frame: str) -> str:
    """Return a name without the leading slash that some publishers still write."""
    return frame.removeprefix("/")


def name_fault(parent: str, child: str) -> tuple[Kind, str] | None:
    """Return why two plain names cannot be parent and child; None if they can."""
    if not parent or not child:
        which = "parent" if not parent else "child"
        return "no_name", f"its {which} has no name"
    if max(len(parent), len(child)) > NAME_LETTERS_MAX:
        return "long_name", f"a name has more than {NAME_LETTERS_MAX} letters"
    if parent == child:
        return "own_parent", "a frame cannot be its own parent"
    return None


def valid_rows(columns: TransformColumns) -> Flags:
    """Return which rows, shape (N,), hold a pose and a stamp that can be used."""
    translations, rotations = columns.translations, columns.rotations_wxyz
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.einsum("ij,ij->i", rotations, rotations)
        # NaN is within no bounds.
        are_turns = np.abs(lengths - 1) <= _SQUARED_LENGTH_OFF
        are_near = (np.abs(translations) <= _FAR_M).all(axis=1)
    return are_turns & are_near & (columns.stamps_ns >= 0)


def number_fault(xyz_m: Floats, wxyz: Floats, stamp_ns: int) -> tuple[Kind, str]:
    """Return why a row that is not valid cannot be used."""
    if not (np.isfinite(xyz_m).all() and np.isfinite(wxyz).all()):
        return "not_finite", "not all its numbers are finite"
    if not wxyz.any():
        return "zero_quaternion", "its quaternion is zero"
    if stamp_ns < 0:
        return "no_stamp", "its stamp is before the beginning of time"
    if np.abs(xyz_m).max() > _FAR_M:
        return "too_far", f"its child is farther away than {_FAR_M:.0e} m"
    length = math.hypot(*wxyz.tolist())  # infinite without a warning, where it is so long
    reason = f"its quaternion has the length {length:.3g}, not 1, and tf2 leaves such out, too"
    return "no_unit_quaternion", reason


def poses_of(columns: TransformColumns) -> Floats:
    """Return poses, shape (N, 7), with quaternions of length 1; invalid rows hold anything."""
    poses = np.empty((len(columns.parents), 7))
    rotations = columns.rotations_wxyz
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        lengths = np.sqrt(np.einsum("ij,ij->i", rotations, rotations))
        poses[:, :4] = rotations / lengths[:, None]
    poses[:, 4:] = columns.translations
    return poses
