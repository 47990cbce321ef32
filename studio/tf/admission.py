"""Admission: which transforms are none, said by sentence."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, Literal, NamedTuple, TypeAlias

import numpy as np

from studio.errors import TransformError

if TYPE_CHECKING:
    from studio.tf.columns import Flags, Floats, TransformColumns

NAME_LETTERS_MAX: Final = 256
_FAR_M: Final = 1e12
_SQUARED_LENGTH_OFF: Final = 1e-2
"""Of a quaternion: tf2 leaves out what is farther from 1."""

Kind: TypeAlias = Literal[
    "no_name", "long_name", "own_parent", "not_finite", "too_far", "zero_quaternion",
    "no_unit_quaternion", "no_stamp", "circle", "other_parent", "too_deep", "too_many", "too_old",
    "moved", "time_jumped", "and_more",
]  # fmt: skip


class Notice(NamedTuple):
    """Something about a transform that was told."""

    kind: Kind
    parent: str
    child: str
    publisher: str
    sentence: str
    left_out: bool = True
    """Whether it was not taken up; else it was, and this is worth knowing."""


def refusal(kind: Kind, parent: str, child: str, publisher: str, reason: str) -> Notice:
    """A transform is left out for a reason."""
    return Notice(kind, parent, child, publisher, str(TransformError(parent, child, reason)))


def plain(frame: str) -> str:
    """Names of tf2 begin with no slash; some that publish still write the old one."""
    return frame.removeprefix("/")


def fault_of_names(parent: str, child: str) -> tuple[Kind, str] | None:
    """Why two plain names are no edge."""
    if not parent or not child:
        which = "parent" if not parent else "child"
        return "no_name", f"its {which} has no name"
    if max(len(parent), len(child)) > NAME_LETTERS_MAX:
        return "long_name", f"a name has more than {NAME_LETTERS_MAX} letters"
    if parent == child:
        return "own_parent", "a frame cannot be its own parent"
    return None


def sound(columns: TransformColumns) -> Flags:
    """Which rows, shape (N,), hold a pose at a time."""
    translations, rotations = columns.translations, columns.rotations_wxyz
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.einsum("ij,ij->i", rotations, rotations)
        # What is no number is within no bounds.
        are_turns = np.abs(lengths - 1) <= _SQUARED_LENGTH_OFF
        are_near = (np.abs(translations) <= _FAR_M).all(axis=1)
    return are_turns & are_near & (columns.stamps_ns >= 0)


def fault_of_numbers(xyz_m: Floats, wxyz: Floats, stamp_ns: int) -> tuple[Kind, str]:
    """Why a row that is not sound is none."""
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
    """Poses, shape (N, 7), with quaternions of length 1; rows that are not sound hold anything."""
    poses = np.empty((len(columns.parents), 7))
    rotations = columns.rotations_wxyz
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        lengths = np.sqrt(np.einsum("ij,ij->i", rotations, rotations))
        poses[:, :4] = rotations / lengths[:, None]
    poses[:, 4:] = columns.translations
    return poses
