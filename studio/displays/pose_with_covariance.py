"""PoseWithCovariance: a pose with an ellipsoid for its position and discs for its orientation."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Final, NamedTuple

import numpy as np

from studio.displays.display import TopicRole, frame_and_stamp
from studio.displays.drawing import Solids
from studio.displays.history import Entry, HistoryDisplay
from studio.displays.poses import (
    NO_TURN_SET,
    NOT_FINITE,
    has_no_turn,
    pose_of,
    pose_properties,
    pose_shapes,
    pose_sizes,
)
from studio.displays.properties import Property, colour_of, rgb_of, switch
from studio.displays.selection import wxyz_of, xyz_of
from studio.displays.turning import product, turned
from studio.robot.rotations import wxyz_from_matrices

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.display import Received
    from studio.displays.drawing import Shape, Wxyz, Xyz
    from studio.displays.poses import Poses
    from studio.displays.properties import Value
    from studio.displays.turning import Flags, Floats

_ON, _POSITION, _ORIENTATION = (
    ("Covariance", (True,)), ("Covariance/Position", (True,)), ("Covariance/Orientation", (True,)),
)  # fmt: skip
_UNIQUE = ("Covariance/Orientation/Color Style", ("Unique",))
_SCALE_MAX: Final = 1000.0

COVARIANCE_PROPERTIES: Final = (
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
    "The covariance is not valid, for a variance is below zero: the rest of it is drawn."
)
_THIN_M = 0.001
# Beyond it the spread of an axis would be a plane.
_SPREAD_MAX_RAD = math.radians(89.0)
# What rounding may leave below zero, of the largest variance.
_ROUNDED = 1e-9
_NO_TURN = np.array([1.0, 0.0, 0.0, 0.0])
_RED_GREEN_BLUE = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], dtype=np.uint8)
# The two directions across each axis, in columns; with the axis behind them they make a turn.
_ACROSS = np.array(
    [[[0, 0], [1, 0], [0, 1]], [[0, 1], [0, 0], [1, 0]], [[1, 0], [0, 1], [0, 0]]],
    dtype=np.float64,
)
# How far the tip of each axis moves along them when the pose turns a little about x, y and z.
_TIPS_FROM_TURN = np.array(
    [[[0, 0, 1], [0, -1, 0]], [[1, 0, 0], [0, 0, -1]], [[0, 1, 0], [-1, 0, 0]]],
    dtype=np.float64,
)
# A cone stands on its tip along z; this lays it along x, flat in the plane of x and y.
_LYING = np.array([math.sqrt(0.5), 0.0, math.sqrt(0.5), 0.0])


class _Own(NamedTuple):
    """Covariances along their own axes.

    Attributes:
        deviations: Shape (M, K), standard ones.
        wxyz: Shape (M, 4): how the axes are turned.
        sound: Shape (M,), whether no variance is below zero.
    """

    deviations: Floats
    wxyz: Floats
    sound: Flags


class Spread(NamedTuple):
    """Uncertainty of a pose.

    Attributes:
        pose: The pose, in the frame of its message.
        is_flat: Whether z, roll and pitch have no variance: a pose in a plane.
        position: One row: deviations along x and y if flat, else along three axes, m.
        orientation: One row of yaw if flat; else three rows for the tips of the axes, rad.
    """

    pose: Poses
    is_flat: bool
    position: _Own
    orientation: _Own


def spread_of(pose: Poses, covariance: NDArray[np.float64]) -> Spread | None:
    """Read the 36 numbers of a message; None when not all can be drawn."""
    matrix = np.array(covariance, dtype=np.float64).reshape(6, 6)
    # Variances are squared: their roots may reach as far as positions.
    if not (np.abs(matrix) <= 1e24).all():
        return None
    is_flat = bool((matrix.diagonal()[2:5] <= 0).all())
    if is_flat:
        yaw = np.array([[matrix[5, 5]]])
        deviations = np.sqrt(np.maximum(yaw, 0.0))
        orientation = _Own(deviations, _NO_TURN[None], yaw[:, 0] >= 0)
        return Spread(
            pose, is_flat, _along_own_axes(matrix[None, :2, :2], _ACROSS[2:]), orientation
        )
    of_tips = _TIPS_FROM_TURN @ matrix[3:, 3:] @ _TIPS_FROM_TURN.transpose(0, 2, 1)
    whole = np.eye(3)[None]
    return Spread(
        pose,
        is_flat,
        _along_own_axes(matrix[None, :3, :3], whole),
        _along_own_axes(of_tips, _ACROSS),
    )


def is_covariance(spread: Spread) -> bool:
    """Whether no variance that would be drawn is below zero."""
    return bool(spread.position.sound.all() and spread.orientation.sound.all())


def covariance_shapes(spread: Spread, values: Mapping[str, Value]) -> dict[str, Shape]:
    """Draw those parts that are switched on."""
    shapes: dict[str, Shape] = {}
    if not values["Covariance"]:
        return shapes
    if values["Covariance/Position"] and (position := _position(spread, values)) is not None:
        shapes["position"] = position
    if values["Covariance/Orientation"] and (spreads := _orientation(spread, values)) is not None:
        shapes["orientation"] = spreads
    return shapes


def _position(spread: Spread, values: Mapping[str, Value]) -> Solids | None:
    own = spread.position
    scale = float(values["Covariance/Position/Scale"])
    if not own.sound[0] or scale == 0 or not own.deviations.any():
        return None
    # One standard deviation to each side; what is sure is still as thick as a sheet.
    diameters = np.full((1, 3), _THIN_M)
    size = own.deviations.shape[1]
    diameters[:, :size] = np.maximum(2.0 * scale * own.deviations, _THIN_M)
    return Solids(
        "sphere",
        spread.pose.xyz.astype(np.float32),
        own.wxyz.astype(np.float32),
        diameters.astype(np.float32),
        colour_of(rgb_of(values["Covariance/Position/Color"])),
        float(values["Covariance/Position/Alpha"]),
    )


def _orientation(spread: Spread, values: Mapping[str, Value]) -> Solids | None:
    offset_m = float(values["Covariance/Orientation/Offset"])
    own = spread.orientation
    seen = own.sound & own.deviations.any(axis=1)
    if offset_m == 0 or not seen.any():
        return None
    if spread.is_flat:
        return _wedge(spread, values, offset_m)
    return _discs(spread, values, offset_m, seen)


def _wedge(spread: Spread, values: Mapping[str, Value], offset_m: float) -> Solids:
    """Return the deviation of the yaw of a pose in a plane, as a flat cone along its x."""
    across_m = float(_widths(spread.orientation.deviations, values)[0, 0]) * offset_m
    return Solids(
        "cone",
        spread.pose.xyz.astype(np.float32),
        product(_base_turn(spread, values), _LYING)[None].astype(np.float32),
        np.array([[_THIN_M, across_m, offset_m]], dtype=np.float32),
        _colours(values)[-1:],
        float(values["Covariance/Orientation/Alpha"]),
    )


def _discs(spread: Spread, values: Mapping[str, Value], offset_m: float, seen: Flags) -> Solids:
    """Return the deviations of the tips of the axes: a disc across each."""
    base, own = _base_turn(spread, values), spread.orientation
    tips = spread.pose.xyz + offset_m * turned(base[None].repeat(3, axis=0), np.eye(3))
    scales = np.full((3, 3), _THIN_M)
    scales[:, :2] = np.maximum(_widths(own.deviations, values) * offset_m, _THIN_M)
    return Solids(
        "cylinder",
        tips[seen].astype(np.float32),
        product(base, own.wxyz)[seen].astype(np.float32),
        scales[seen].astype(np.float32),
        _colours(values)[seen],
        float(values["Covariance/Orientation/Alpha"]),
    )


def _along_own_axes(variances: Floats, planes: Floats) -> _Own:
    """Covariances (M, K, K) along their own axes.

    Args:
        variances: In directions which are the columns of `planes`.
        planes: Shape (M, 3, K); for K of 2 a third direction, across both, completes the turn.
    """
    # As in RViz, only the lower half is read: the upper one should be the same.
    squares, axes = np.linalg.eigh(variances, UPLO="L")
    axes[np.linalg.det(axes) < 0, :, 0] *= -1.0
    turns = np.empty((len(variances), 3, 3))
    size = variances.shape[1]
    turns[:, :, :size] = planes @ axes
    if size == 2:
        turns[:, :, 2] = np.cross(turns[:, :, 0], turns[:, :, 1])
    sound = squares.min(axis=1) >= -_ROUNDED * np.abs(squares).max(axis=1)
    return _Own(np.sqrt(np.maximum(squares, 0.0)), wxyz_from_matrices(turns), sound)


def _widths(deviations_rad: Floats, values: Mapping[str, Value]) -> Floats:
    """Return the widths of deviations of an angle at a distance of 1 m."""
    scale = float(values["Covariance/Orientation/Scale"])
    return 2.0 * np.tan(np.minimum(deviations_rad * scale, _SPREAD_MAX_RAD))


def _base_turn(spread: Spread, values: Mapping[str, Value]) -> Floats:
    local = values["Covariance/Orientation/Frame"] == "Local"
    return spread.pose.wxyz[0] if local else _NO_TURN


def _colours(values: Mapping[str, Value]) -> NDArray[np.uint8]:
    """Return the colours of the three axes, shape (3, 3)."""
    if values["Covariance/Orientation/Color Style"] == "RGB":
        return _RED_GREEN_BLUE
    return np.tile(colour_of(rgb_of(values["Covariance/Orientation/Color"])), (3, 1))


class SpreadDisplay(HistoryDisplay[Spread]):
    """Draws poses with a covariance; derived classes decide which orientations they take."""

    ITEM = "pose"
    UNDER: ClassVar[str] = ""
    """The prefix of the names of the properties of a pose."""

    def read(self, received: Received) -> Entry[Spread] | None:
        """Return the pose and its covariance, unless their numbers cannot be drawn."""
        message = self.decode(received)
        pose = pose_of(message.pose.pose)
        spread = None if pose is None else spread_of(pose, message.pose.covariance)
        if spread is None:
            return self.refuse("not_finite", NOT_FINITE)
        if not self.takes_turn(message.pose.pose.orientation):
            return None
        if not is_covariance(spread):
            self.warn(None, NOT_POSITIVE)
        return Entry(*frame_and_stamp(message.header), spread)

    @abstractmethod
    def takes_turn(self, turn: Any) -> bool:  # noqa: ANN401 - a message
        """Whether to draw a pose of this orientation; report what is wrong with it."""

    def shapes(self, content: Spread) -> dict[str, Shape]:
        """Return the pose, an ellipsoid, and the spread of its axes."""
        pose = pose_shapes(content.pose, self.values, self.UNDER)
        return pose | covariance_shapes(content, self.values)

    def message_pose(self, content: Spread) -> tuple[Xyz, Wxyz]:
        """Return the pose."""
        return xyz_of(content.pose.xyz[0]), wxyz_of(content.pose.wxyz[0])

    def sizes(self) -> tuple[str, ...]:
        """Return the properties with its length, 0 of which still shows the covariance."""
        return pose_sizes(self.values, self.UNDER)


class PoseWithCovarianceDisplay(SpreadDisplay):
    """Draws the newest pose."""

    KIND = "PoseWithCovariance"
    DOC = "A pose and how sure it is, as localisation publishes it."
    ICON = "pose"
    TOPICS = (TopicRole("", ("geometry_msgs/msg/PoseWithCovarianceStamped",)),)
    PROPERTIES = (*pose_properties(), *COVARIANCE_PROPERTIES)

    def takes_turn(self, turn: Any) -> bool:  # noqa: ANN401 - a message
        """Take any, and warn where none is set."""
        if has_no_turn(turn):
            self.warn(None, NO_TURN_SET)
        return True
