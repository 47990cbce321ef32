"""Image: the picture of a camera, at the far end of the frustum that its camera info gives."""

from __future__ import annotations

import math
from collections import deque
from statistics import median
from typing import TYPE_CHECKING, Any, ClassVar, Final, NamedTuple

import numpy as np

from studio.displays.display import (
    Status,
    StillDisplay,
    TopicRole,
    frame_and_stamp,
    reading_fields,
)
from studio.displays.drawing import NOTHING, Frustum, Placed
from studio.displays.image_encodings import COMPRESSED, IMAGE, read_pixels
from studio.displays.properties import Property, rgb_of
from studio.displays.selection import NEWEST, Fact, Item, box_of, number_fact

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from studio.displays.display import Received
    from studio.displays.drawing import Drawing
    from studio.displays.properties import Value
    from studio.displays.selection import Picked
    from studio.ros.types.library import TypeLibrary

_INFO: Final = "camera_info"
_PATH: Final = "camera"
_OF_SHADES: Final = ("Normalize Range", "Min Value", "Max Value", "Median window")
_WINDOW_MAX: Final = 100
# Of usual cameras, until the camera info comes.
_GUESSED_FOV_Y_RAD: Final = math.radians(45.0)
_SKEWED: Final = 0.05


class _View(NamedTuple):
    """The field of view that a camera info gives."""

    fov_y_rad: float
    aspect: float
    skewed: bool


IMAGE_TOPICS: Final = (
    TopicRole("", (IMAGE, COMPRESSED), reliable=False),
    TopicRole(_INFO, ("sensor_msgs/msg/CameraInfo",), beside="/camera_info", reliable=False),
)
SHADE_PROPERTIES: Final = (
    Property(
        "Normalize Range", "switch", True,  # noqa: FBT003 - its first value
        "Whether depths reach from black to white between the least and the greatest.",
    ),
    Property("Min Value", "number", 0.0, "What is black.", when=("Normalize Range", (False,))),
    Property("Max Value", "number", 1.0, "What is white.", when=("Normalize Range", (False,))),
    Property(
        "Median window", "whole", 5, "Over how many pictures the range is evened out.",
        low=1, high=_WINDOW_MAX, when=("Normalize Range", (True,)),
    ),
)  # fmt: skip


class ImageDisplay(StillDisplay):
    """Draws the newest picture where the camera is, as wide as it sees."""

    KIND: ClassVar[str] = "Image"
    DOC: ClassVar[str] = "The picture of a camera, in front of the camera in 3D."
    ICON: ClassVar[str] = "camera"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = IMAGE_TOPICS
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property(
            "Far clip", "number", 1.0, "How far in front of the camera the picture is.",
            low=0.01, high=1000.0, unit="m",
        ),
        Property("Alpha", "number", 1.0, "How opaque the picture is.", low=0.0, high=1.0),
        Property("Edge color", "colour", "#7d7d7d", "Of the edges of what the camera sees."),
        *SHADE_PROPERTIES,
    )  # fmt: skip

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self.reset()

    def reset(self) -> None:
        """Forget the picture and the camera info."""
        self.pixels: NDArray[Any] | None = None
        """The picture as it was read; None before one came."""
        self._shaded: NDArray[np.uint8] | None = None
        self.size: tuple[int, int] | None = None
        """Width and height of the picture as it was sent; of a compressed one as it was read."""
        self.frame, self.stamp_ns = "", 0
        self._encoding, self._is_packed = "", False
        self._view: _View | None = None
        self._has_info = False
        self._ranges: deque[tuple[float, float]] = deque(maxlen=_WINDOW_MAX)
        self.redraw()

    def changed(self, name: str) -> None:
        """Take new settings; the picture itself is drawn again only when its shades change."""
        if name in _OF_SHADES:
            self._shaded = None
        self.redraw()

    def take(self, received: Received, role: str = "") -> None:
        """Take a picture or a camera info.

        Raises:
            StudioError: It cannot be read, or is of an unknown encoding.
        """
        message = self.decode(received)
        with reading_fields(received.type_name):
            if role == _INFO:
                self._take_info(message)
            else:
                self._take_picture(received.type_name, message)

    def picked(self, picked: Picked) -> Sequence[str]:
        """Return the picture as a whole."""
        return (NEWEST,) if picked.path == _PATH else ()

    def item(self, key: str) -> Item | None:
        """Return the picture, with a box around what the camera sees."""
        if key != NEWEST or self._drawing is None or _PATH not in self._drawing:
            return None
        box = box_of(self._drawing[_PATH].shapes)
        return Item("image", "", _PATH, self.frame, self.stamp_ns, box)

    def facts(self, key: str) -> tuple[Fact, ...]:
        """Return size and field of view."""
        if key != NEWEST or self.pixels is None:
            return ()
        found = [Fact("encoding", self._encoding[:300])]
        if self.size is not None and not self._is_packed:
            found += [Fact("width", self.size[0]), Fact("height", self.size[1])]
        if self._view is not None:
            found.append(number_fact("field_of_view", self._view.fov_y_rad, "rad"))
        return tuple(found)

    def _take_picture(self, type_name: str, message: Any) -> None:  # noqa: ANN401
        pixels, size = read_pixels(message, type_name, self.limits.pixels)
        self.frame, self.stamp_ns = frame_and_stamp(message.header)
        self.pixels, self.size = pixels, size
        is_packed = self._is_packed = type_name == COMPRESSED
        self._encoding = str(message.format if is_packed else message.encoding)
        self._shaded = None
        if _is_numbers(pixels):
            self._ranges.append(_range_of(pixels))
        self.redraw()

    def statuses(self) -> tuple[Status, ...]:
        """Return why no picture is seen, or not where the camera points."""
        if self.pixels is None:
            return ()
        if not self.pixels.size:
            return (Status("warn", "empty", "The picture has no pixels."),)
        found = (self._unseen(), self._no_view(), self._transparent())
        return tuple(one for one in found if one is not None)

    def _take_info(self, info: Any) -> None:  # noqa: ANN401 - a sensor_msgs/CameraInfo
        view = view_of(info)
        if view != self._view or not self._has_info:
            self._view, self._has_info = view, True
            self.redraw()

    def _drawn(self) -> Drawing:
        pixels = self.pixels
        if pixels is None or not pixels.size:
            return NOTHING
        aspect = pixels.shape[1] / pixels.shape[0]
        view = self._view or _View(_GUESSED_FOV_Y_RAD, aspect, skewed=False)
        shape = Frustum(
            fov_y_rad=view.fov_y_rad,
            aspect=view.aspect,
            far_m=float(self.values["Far clip"]),
            image=self.shades(pixels),
            rgb=rgb_of(self.values["Edge color"]),
            opacity=float(self.values["Alpha"]),
        )
        return {_PATH: Placed(self.frame, self.stamp_ns, {"picture": shape})}

    def shades(self, pixels: NDArray[Any]) -> NDArray[np.uint8]:
        """Return the picture in colours; numbers become shades of grey."""
        if self._shaded is None:
            self._shaded = self._shades(pixels)
        return self._shaded

    def _shades(self, pixels: NDArray[Any]) -> NDArray[np.uint8]:
        if pixels.ndim == 3:
            return pixels
        if pixels.dtype == np.uint8:
            return np.repeat(pixels[..., None], 3, axis=2)
        low, high = self._bounds()
        with np.errstate(all="ignore"):
            shares = (pixels.astype(np.float32) - low) / ((high - low) or 1.0)
            shades = np.nan_to_num(np.clip(shares, 0, 1) * 255, nan=0.0).astype(np.uint8)
        return np.repeat(shades[..., None], 3, axis=2)

    def _bounds(self) -> tuple[float, float]:
        if not self.values["Normalize Range"]:
            return float(self.values["Min Value"]), float(self.values["Max Value"])
        recent = list(self._ranges)[-int(self.values["Median window"]) :]
        return median(low for low, _ in recent), median(high for _, high in recent)

    def _unseen(self) -> Status | None:
        pixels = self.pixels
        if pixels is None or pixels.dtype.kind != "f" or np.isfinite(pixels).any():
            return None
        return Status("warn", "not_finite", "All depths are NaN or infinite: the picture is black.")

    def _no_view(self) -> Status | None:
        if self._view is None:
            found = "has no focal length" if self._has_info else "has not come"
            degrees = round(math.degrees(_GUESSED_FOV_Y_RAD))
            sentence = (
                f"The camera info {found}: the angle of view is guessed as {degrees} degrees."
            )
            return Status("warn", "no_camera_info", sentence)
        if self._view.skewed:
            sentence = (
                "The camera's axis is not in the middle of its picture: drawn as if it were there."
            )
            return Status("ok", None, sentence)
        return None

    def _transparent(self) -> Status | None:
        if float(self.values["Alpha"]) > 0.0:
            return None
        sentence = "Alpha is 0: the edges alone are seen."
        return Status("warn", "transparent", sentence, ("Alpha", 1.0))


def view_of(info: Any) -> _View | None:  # noqa: ANN401 - a sensor_msgs/CameraInfo
    """Return the field of view by the projection matrix, else by that of the raw picture.

    Returns:
        None when there is no focal length.
    """
    width, height = float(info.width), float(info.height)
    if not width * height:
        return None
    p, k = info.p, info.k
    for fx, fy, cx, cy in ((p[0], p[5], p[2], p[6]), (k[0], k[4], k[2], k[5])):
        values = np.array([fx, fy, cx, cy])
        if np.isfinite(values).all() and fx > 0.0 and fy > 0.0:
            fov_y_rad = 2.0 * math.atan(height / (2.0 * float(fy)))
            aspect = (width * float(fy)) / (height * float(fx))
            if not (1e-3 < fov_y_rad < 3.1 and 1e-3 < aspect < 1e3):
                continue
            away = max(abs(cx / width - 0.5), abs(cy / height - 0.5))
            return _View(fov_y_rad, aspect, bool(away > _SKEWED))
    return None


def _is_numbers(pixels: NDArray[Any]) -> bool:
    return pixels.ndim == 2 and pixels.dtype != np.uint8 and pixels.size > 0


def _range_of(pixels: NDArray[Any]) -> tuple[float, float]:
    """Return the least and the greatest number that is one; of none both are 0."""
    finite = pixels if pixels.dtype.kind != "f" else pixels[np.isfinite(pixels)]
    return (float(finite.min()), float(finite.max())) if finite.size else (0.0, 0.0)
