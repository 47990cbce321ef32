"""Rows: of many poses or points, those that can be drawn, and what is said of the others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from studio.displays.pose_look import Poses
from studio.displays.turning import drawable, unit_quaternions

if TYPE_CHECKING:
    from studio.displays.display import Reason
    from studio.displays.properties import Value
    from studio.displays.turning import Flags, Floats

_WXYZ = [6, 3, 4, 5]


class Teller(Protocol):
    """A display to which can be said what is left out."""

    def refuse(self, reason: Reason, sentence: str) -> None:
        """Say why nothing of a message can be drawn."""
        ...

    def thin(self, sentence: str) -> None:
        """Say how much is drawn."""
        ...

    def warn(
        self, reason: Reason | None, sentence: str, mend: tuple[str, Value] | None = None
    ) -> None:
        """Say what is odd, or left out."""
        ...


def poses_of_rows(rows: Floats, what: str, at_most: int, teller: Teller) -> Poses | None:
    """Poses of rows (N, 7) of x, y, z and a quaternion x, y, z, w.

    Args:
        rows: As they were sent.
        what: What they are called, in the plural.
        at_most: How many are drawn; of more than those every so manieth is.
        teller: Who is told what is left out.

    Returns:
        None when there are some and none can be drawn.
    """
    chosen = chosen_rows(rows, drawable_poses(rows), what, at_most, teller)
    return None if chosen is None else poses_of_chosen(chosen, what, teller)


def poses_of_chosen(chosen: Floats, what: str, teller: Teller) -> Poses:
    """Poses of rows (N, 7 or more) that can all be drawn."""
    wxyz, zero = unit_quaternions(chosen[:, _WXYZ])
    if zero.any():
        teller.warn(
            None,
            f"{int(zero.sum()):,} of {len(chosen):,} {what} have a quaternion of zeros, drawn as "
            "no turn: their publisher should set w to 1.",
        )
    return Poses(chosen[:, :3], wxyz)


def drawable_poses(rows: Floats) -> Flags:
    """Which rows (N, 7) are poses that can be drawn."""
    return drawable(rows[:, :3]) & np.isfinite(rows[:, 3:7]).all(axis=1)


def chosen_rows(
    rows: Floats, sound: Flags, what: str, at_most: int, teller: Teller
) -> Floats | None:
    """Those of rows (N, K) that are drawn: the sound ones, spread evenly if there are too many."""
    count = len(rows)
    if count and not sound.any():
        teller.refuse(
            "not_finite",
            f"None of the {count:,} {what} has numbers that are finite and below 1e12.",
        )
        return None
    chosen = rows if sound.all() else rows[sound]
    if not count:
        teller.warn("empty", f"The message holds no {what}.")
    elif len(chosen) < count:
        missing = count - len(chosen)
        teller.warn(
            "not_finite",
            f"{missing:,} of {count:,} {what} are left out: their numbers are not finite or beyond "
            "1e12.",
        )
    if len(chosen) <= at_most:
        return chosen
    teller.thin(f"Showing {at_most:,} of {count:,} {what}: more would make the view slow.")
    return chosen[np.linspace(0, len(chosen) - 1, at_most).astype(np.intp)]
