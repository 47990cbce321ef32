"""The pinhole that a sensor_msgs/CameraInfo describes, in pixels of the picture that came."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_PLUMB_BOB: Final = ("plumb_bob", "rational_polynomial")
_FAR_PX: Final = 1e6
_SEEN_PX: Final = 0.5
"""A smaller shift is seen by nobody."""


class Pinhole(NamedTuple):
    """Where a point in front of a camera is in its picture: u = fx x / z + cx, v = fy y / z + cy.

    Attributes:
        fx: Focal length along a row, px.
        fy: Focal length down a column, px.
        cx: Principal point, px from the left edge.
        cy: Principal point, px from the upper edge.
        x_m: Where the eye is beside the frame of the picture, along its x: of the right camera of
            a stereo pair it is the baseline.
        y_m: The same along its y.
    """

    fx: float
    fy: float
    cx: float
    cy: float
    x_m: float = 0.0
    y_m: float = 0.0


def pinhole_of(
    info: Any,  # noqa: ANN401 - a sensor_msgs/CameraInfo
    size: tuple[int, int],
    first: Literal["k", "p"],
) -> Pinhole | None:
    """Return the pinhole of a picture; a region of interest and binning are accounted for.

    Args:
        info: Its K is of the picture as it is taken, its P of the rectified one.
        size: Width and height of the picture that came, px.
        first: The matrix to take; the other one is taken where this has no focal length.

    Returns:
        None when neither matrix has a focal length, or a number is not finite.
    """
    for name in (first, "p" if first == "k" else "k"):
        matrix = np.asarray(getattr(info, name), np.float64)
        if name == "p":
            fx, fy, cx, cy = (float(matrix[at]) for at in (0, 5, 2, 6))
            shift = float(matrix[3]), float(matrix[7])
        else:
            fx, fy, cx, cy = (float(matrix[at]) for at in (0, 4, 2, 5))
            shift = 0.0, 0.0
        if np.isfinite([fx, fy, cx, cy, *shift]).all() and 0.0 < min(fx, fy) < _FAR_PX:
            x_px, y_px, columns, rows = _region(info, size)
            wide, high = size[0] / columns, size[1] / rows
            return Pinhole(
                fx * wide, fy * high, (cx - x_px) * wide, (cy - y_px) * high,
                -shift[0] / fx, -shift[1] / fy,
            )  # fmt: skip
    return None


def _region(info: Any, size: tuple[int, int]) -> tuple[int, int, int, int]:  # noqa: ANN401
    """Return the left, upper corner and the size of what was read out, in pixels of the sensor."""
    roi = info.roi
    if roi.width and roi.height:
        return int(roi.x_offset), int(roi.y_offset), int(roi.width), int(roi.height)
    return 0, 0, int(info.width) or max(size[0], 1), int(info.height) or max(size[1], 1)


def calibration_of(info: Any) -> tuple[object, ...]:  # noqa: ANN401 - a sensor_msgs/CameraInfo
    """Return all that says what a camera sees: two of one calibration are equal."""
    roi = info.roi
    lens = tuple(np.asarray(one, np.float64).tobytes() for one in (info.d, info.k, info.p))
    region = (roi.x_offset, roi.y_offset, roi.width, roi.height)
    return (info.width, info.height, info.distortion_model, *region, *lens)


def distortion_px(info: Any, size: tuple[int, int]) -> float | None:  # noqa: ANN401
    """Return how far the lens moves a pixel of the picture's edge from where a pinhole has it.

    Returns:
        0 without distortion; None when there is one of a model that is not computed here.
    """
    d = np.asarray(info.d, np.float64)
    if not d.size or not d.any():
        return 0.0
    pinhole = pinhole_of(info, size, "k")
    if pinhole is None or str(info.distortion_model) not in _PLUMB_BOB or not np.isfinite(d).all():
        return None
    x, y = _edge(pinhole, size)
    with np.errstate(all="ignore"):
        there_x, there_y = distorted(x, y, d)
        shift = np.hypot((there_x - x) * pinhole.fx, (there_y - y) * pinhole.fy).max()
    if not np.isfinite(shift):
        return None
    return float(shift) if shift > _SEEN_PX else 0.0


def distorted(
    x: NDArray[np.float64], y: NDArray[np.float64], d: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return where a lens puts directions (x / z, y / z), by the numbers of OpenCV's models."""
    k1, k2, p1, p2, k3, k4, k5, k6 = np.pad(d[:8], (0, max(0, 8 - d.size)))[:8]
    r2 = x * x + y * y
    radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    return (
        x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
        y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y,
    )


def _edge(
    pinhole: Pinhole, size: tuple[int, int]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the directions of some pixels along the edge of a picture."""
    u, v = (np.linspace(0, end, 9) for end in size)
    left, upper = np.zeros(9), np.zeros(9)
    columns = np.concatenate((u, u, left, left + size[0]))
    rows = np.concatenate((upper, upper + size[1], v, v))
    return (columns - pinhole.cx) / pinhole.fx, (rows - pinhole.cy) / pinhole.fy
