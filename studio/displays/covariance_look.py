"""CovarianceLook: how sure a pose is: an ellipsoid for its position, discs for its orientation."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.drawing import Solids
from studio.displays.pose_look import colour_of, switch
from studio.displays.properties import Property, rgb_of
from studio.displays.turning import product, turned
from studio.robot.rotations import wxyz_from_matrices

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Shape
    from studio.displays.pose_look import Poses
    from studio.displays.properties import Value
    from studio.displays.turning import Floats

_ON, _POSITION, _ORIENTATION = (
    ("Covariance", (True,)), ("Covariance/Position", (True,)), ("Covariance/Orientation", (True,)),
)  # fmt: skip
_UNIQUE = ("Covariance/Orientation/Color Style", ("Unique",))
_SCALE_MAX: Final = 1000.0

PROPERTIES: Final = (
    switch("Covariance", "Whether it is shown how sure the pose is.", on=True),
    switch("Covariance/Position", "Whether the ellipsoid is shown.", on=True, when=_ON),
    Property("Covariance/Position/Color", "colour", "#cc33cc", "Colour of the ellipsoid.",
             when=_POSITION),
    Property("Covariance/Position/Alpha", "number", 0.3, "How opaque the ellipsoid is.", 0.0, 1.0,
             when=_POSITION),
    Property("Covariance/Position/Scale", "number", 1.0,
             "How many standard deviations the ellipsoid measures.", 0.0, _SCALE_MAX,
             when=_POSITION),
    switch("Covariance/Orientation",
           "Whether the spread of each axis is shown, or of yaw alone for poses in a plane.",
           on=True, when=_ON),
    Property("Covariance/Orientation/Frame", "choice", "Local",
             "Whose axes spread: those of the pose, or those of its frame.",
             choices=("Local", "Fixed"), when=_ORIENTATION),
    Property("Covariance/Orientation/Color Style", "choice", "Unique",
             "One colour for all axes, or red, green and blue.",
             choices=("Unique", "RGB"), when=_ORIENTATION),
    Property("Covariance/Orientation/Color", "colour", "#ffff7f", "Colour of the spread.",
             when=_UNIQUE),
    Property("Covariance/Orientation/Alpha", "number", 0.5, "How opaque the spread is.", 0.0, 1.0,
             when=_ORIENTATION),
    Property("Covariance/Orientation/Offset", "number", 1.0,
             "How far from the pose the spread is drawn.", 0.0, _SCALE_MAX, "m",
             when=_ORIENTATION),
    Property("Covariance/Orientation/Scale", "number", 1.0,
             "How many standard deviations the spread measures.", 0.0, _SCALE_MAX,
             when=_ORIENTATION),
)  # fmt: skip

NOT_POSITIVE: Final = (
    "The covariance is none: it says that a variance is below zero; what it says of the rest is "
    "drawn."
)
_THIN_M = 0.001
# Beyond it the spread of an axis would be a plane.
_SPREAD_MAX_RAD = math.radians(89.0)
# What rounding may leave below zero, of the largest variance.
_ROUNDED = 1e-9
_NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
_RED_GREEN_BLUE = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], dtype=np.uint8)
# How the tip of each axis moves when the pose turns a little about x, y and z: the cross product.
_TIPS_FROM_TURN = np.array(
    [
        [[0, 0, 0], [0, 0, 1], [0, -1, 0]],
        [[0, 0, -1], [0, 0, 0], [1, 0, 0]],
        [[0, 1, 0], [-1, 0, 0], [0, 0, 0]],
    ],
    dtype=np.float64,
)
# A cone stands on its tip along z; this lays it along x, flat in the plane of x and y.
_LYING = np.array([math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0])


class Spread(NamedTuple):
    """How sure a pose is.

    Attributes:
        pose: Whose it is, in the frame of its message.
        covariance: Shape (6, 6), float64: of x, y, z in m and turns about x, y, z in rad.
    """

    pose: Poses
    covariance: Floats

    @property
    def is_flat(self) -> bool:
        """Whether the pose lies in a plane: z, roll and pitch are never said to be unsure."""
        return bool((self.covariance.diagonal()[2:5] <= 0).all())


def spread_of(pose: Poses, covariance: NDArray[np.float64]) -> Spread | None:
    """Read the 36 numbers of a message; None when not all can be drawn."""
    matrix = np.array(covariance, dtype=np.float64).reshape(6, 6)
    # Variances are squared: their roots may reach as far as positions.
    if not (np.abs(matrix) <= 1e24).all():
        return None
    return Spread(pose, matrix)


def is_covariance(spread: Spread) -> bool:
    """Whether no variance that would be drawn is below zero."""
    parts = (slice(0, 2), slice(5, 6)) if spread.is_flat else (slice(0, 3), slice(3, 6))
    return all(_deviations(spread.covariance[part, part])[2] for part in parts)


def covariance_shapes(spread: Spread, values: Mapping[str, Value]) -> dict[str, Shape]:
    """Draw what the properties say is seen of it."""
    shapes: dict[str, Shape] = {}
    if not values["Covariance"]:
        return shapes
    if values["Covariance/Position"] and (position := _position(spread, values)) is not None:
        shapes["position"] = position
    if values["Covariance/Orientation"] and (spreads := _orientation(spread, values)) is not None:
        shapes["orientation"] = spreads
    return shapes


def _position(spread: Spread, values: Mapping[str, Value]) -> Solids | None:
    size = 2 if spread.is_flat else 3
    deviations, axes, sound = _deviations(spread.covariance[:size, :size])
    scale = float(values["Covariance/Position/Scale"])
    if not sound or scale == 0 or not deviations.any():
        return None
    diameters, turn = np.full(3, _THIN_M), np.eye(3)
    # One standard deviation to each side; what is sure is still as thick as a sheet.
    diameters[:size] = np.maximum(2.0 * scale * deviations, _THIN_M)
    turn[:size, :size] = axes
    return Solids(
        "sphere",
        spread.pose.xyz.astype(np.float32),
        wxyz_from_matrices(turn[None]).astype(np.float32),
        diameters[None].astype(np.float32),
        colour_of(rgb_of(values["Covariance/Position/Color"])),
        float(values["Covariance/Position/Alpha"]),
    )


def _orientation(spread: Spread, values: Mapping[str, Value]) -> Solids | None:
    offset_m = float(values["Covariance/Orientation/Offset"])
    if offset_m == 0:
        return None
    return (_wedge if spread.is_flat else _discs)(spread, values, offset_m)


def _wedge(spread: Spread, values: Mapping[str, Value], offset_m: float) -> Solids | None:
    """How far the yaw of a pose in a plane may be off, as a flat cone along its x."""
    deviations, _, sound = _deviations(spread.covariance[5:, 5:])
    if not sound or not deviations[0]:
        return None
    across_m = _across(deviations, values)[0] * offset_m
    return Solids(
        "cone",
        spread.pose.xyz.astype(np.float32),
        product(_base_turn(spread, values), _LYING)[None].astype(np.float32),
        np.array([[_THIN_M, across_m, offset_m]], dtype=np.float32),
        _colours(values)[-1:],
        float(values["Covariance/Orientation/Alpha"]),
    )


def _discs(spread: Spread, values: Mapping[str, Value], offset_m: float) -> Solids | None:
    """Where the tips of the axes may be: a disc across each."""
    base = _base_turn(spread, values)
    turns, scales, seen = [_NO_TURN] * 3, np.full((3, 3), _THIN_M), np.zeros(3, dtype=np.bool_)
    for axis, tip_from_turn in enumerate(_TIPS_FROM_TURN):
        across = [(axis + 1) % 3, (axis + 2) % 3]
        of_tip = tip_from_turn @ spread.covariance[3:, 3:] @ tip_from_turn.T
        deviations, axes, sound = _deviations(of_tip[np.ix_(across, across)])
        seen[axis] = sound and bool(deviations.any())
        turn = np.zeros((3, 3))
        turn[across, :2] = axes
        turn[axis, 2] = 1.0
        turns[axis] = product(base, wxyz_from_matrices(turn))
        scales[axis, :2] = np.maximum(_across(deviations, values) * offset_m, _THIN_M)
    if not seen.any():
        return None
    places = spread.pose.xyz + turned(np.tile(base, (3, 1)), offset_m * np.eye(3))
    return Solids(
        "cylinder",
        places[seen].astype(np.float32),
        np.array(turns)[seen].astype(np.float32),
        scales[seen].astype(np.float32),
        _colours(values)[seen],
        float(values["Covariance/Orientation/Alpha"]),
    )


def _deviations(variances: Floats) -> tuple[Floats, Floats, bool]:
    """The standard deviations of a covariance (K, K) along its own axes, which make a turn.

    Returns:
        Deviations (K,), axes in columns (K, K), and whether it is a covariance.
    """
    # As in RViz, only the lower half is read: the upper one should be the same.
    squares, axes = np.linalg.eigh(variances, UPLO="L")
    if np.linalg.det(axes) < 0:
        axes[:, 0] = -axes[:, 0]
    sound = bool(squares.min() >= -_ROUNDED * np.abs(squares).max())
    return np.sqrt(np.maximum(squares, 0.0)), axes, sound


def _across(deviations_rad: Floats, values: Mapping[str, Value]) -> Floats:
    """What deviations of an angle measure from side to side at a distance of 1 m."""
    scale = float(values["Covariance/Orientation/Scale"])
    return 2.0 * np.tan(np.minimum(deviations_rad * scale, _SPREAD_MAX_RAD))


def _base_turn(spread: Spread, values: Mapping[str, Value]) -> Floats:
    local = values["Covariance/Orientation/Frame"] == "Local"
    return spread.pose.wxyz[0] if local else _NO_TURN


def _colours(values: Mapping[str, Value]) -> NDArray[np.uint8]:
    """Of the three axes, shape (3, 3)."""
    if values["Covariance/Orientation/Color Style"] == "RGB":
        return _RED_GREEN_BLUE
    return np.tile(colour_of(rgb_of(values["Covariance/Orientation/Color"])), (3, 1))
