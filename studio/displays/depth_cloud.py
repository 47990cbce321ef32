"""DepthCloud: a depth image as points in space, in the colours of another camera's picture."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, Final, NamedTuple

import numpy as np

from studio.displays.cloud import Cloud, evenly_among
from studio.displays.cloud_display import CLOUD_PROPERTIES, CloudDisplay
from studio.displays.display import Status, TopicRole, reading_fields, stamp_ns_of
from studio.displays.image_encodings import COMPRESSED, IMAGE, read_pixels
from studio.displays.occlusion import Occlusion
from studio.displays.pinhole import calibration_of, pinhole_of
from studio.displays.properties import Property, switch
from studio.displays.turning import angle_between_rad
from studio.errors import DisplayMessageError, StudioError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.display import Limits, Received
    from studio.displays.drawing import Points
    from studio.displays.pinhole import Pinhole
    from studio.displays.properties import Value
    from studio.ros.types.library import TypeLibrary
    from studio.tf.frames import FramesNow

_INFO_TYPE: Final = "sensor_msgs/msg/CameraInfo"
_INFO, _COLOUR = "camera_info", "color"
PIXELS_MAX: Final = 4_000_000
"""Of a larger picture every second pixel is read, or every third, ..."""
_MM: Final = 0.001
_APART_NS: Final = 500_000_000
"""Farther apart, a depth image and a picture do not show the same."""
_RELIABLE: Final[dict[str, bool | None]] = {
    "Best effort": None,
    "System Default": None,
    "Reliable": True,
}
_AUTO_SIZE, _OCCLUSION = "Auto Size", "Occlusion Compensation"
_AGAIN: Final = ("", "CameraInfo Topic", "Color Image Topic", "Color Transport Hint")


def _depth_properties() -> tuple[Property, ...]:
    return (
        Property(
            "Reliability Policy", "choice", "Best effort",
            "Whether lost pictures are sent again; if not chosen, as fits those who publish.",
            choices=tuple(_RELIABLE),
        ),
        Property(
            "Depth Map Transport Hint", "choice", "raw", "How the depth image comes packed.",
            choices=("raw", "compressed", "compressedDepth"),
        ),
        Property(
            "CameraInfo Topic", "topic", "",
            "The calibration of the depth camera; empty: camera_info beside the depth image.",
            choices=(_INFO_TYPE,),
        ),
        Property(
            "Color Image Topic", "topic", "",
            "The picture whose colours the points have; empty: they have none.",
            choices=(IMAGE, COMPRESSED),
        ),
        Property(
            "Color Transport Hint", "choice", "raw", "How the picture comes packed.",
            choices=("raw", "compressed"),
        ),
        Property(
            "Queue Size", "whole", 5, "Number of pictures kept to match depths with colours.",
            low=1, high=100,
        ),
        switch(_AUTO_SIZE, "Makes each point as large as the pixel that measured it.", on=True),
        Property(
            "Auto Size/Auto Size Factor", "number", 1.0, "Times as large as that pixel.",
            low=0.0001, high=1000.0, when=(_AUTO_SIZE, (True,)),
        ),
        switch(
            _OCCLUSION, "Keeps what something nearer hides, while the camera does not move.",
            on=False,
        ),
        Property(
            "Occlusion Compensation/Occlusion Time-Out", "number", 30.0,
            "How long what is hidden is kept.", low=0.0, high=3600.0, unit="s",
            when=(_OCCLUSION, (True,)),
        ),
    )  # fmt: skip


class DepthFields:
    """What the points of a depth image have beside their places: the colours of a picture."""

    names: tuple[str, ...] = ("x", "y", "z")

    def __init__(self, columns: NDArray[np.float32], rows: NDArray[np.float32]) -> None:
        """Make those of points at these pixels, as shares of the width and the height, (N,)."""
        self._columns, self._rows = columns, rows
        self.picture: NDArray[np.uint8] | None = None
        """Shape (H, W, 3), of any size; None before one came."""

    @property
    def size_bytes(self) -> int:
        """Memory of it, with the picture, which others may have, too."""
        picture = 0 if self.picture is None else self.picture.nbytes
        return self._columns.nbytes + self._rows.nbytes + picture

    def numbers(self, name: str, raw: NDArray[np.intp] | None) -> NDArray[np.float32] | None:
        """There are no others."""
        del name, raw

    def float_colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """There are none."""
        del raw

    def colours(self, raw: NDArray[np.intp] | None) -> NDArray[np.uint8] | None:
        """Return the colour of the picture where each point is in it, shape (N, 3), or None."""
        del raw
        if self.picture is None:
            return None
        height, width = self.picture.shape[:2]
        rows = np.minimum((self._rows * height).astype(np.intp), height - 1)
        columns = np.minimum((self._columns * width).astype(np.intp), width - 1)
        return self.picture[rows, columns]


class _Depth(NamedTuple):
    """A depth image: m, shape (H, W), NaN or 0 where nothing was measured; and its full size."""

    depths_m: NDArray[np.float32]
    size: tuple[int, int]


class DepthCloudDisplay(CloudDisplay):
    """Draws the points of a depth image in its frame: x to the right, y down, z forward."""

    KIND: ClassVar[str] = "DepthCloud"
    DOC: ClassVar[str] = "A depth image as points in space, in the colours of a picture."
    ICON: ClassVar[str] = "cloud"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", (IMAGE, COMPRESSED), reliable=False),
        TopicRole(_INFO, (_INFO_TYPE,), beside="/camera_info", reliable=False),
        TopicRole(_COLOUR, (IMAGE, COMPRESSED), reliable=False, newest_only=False),
    )
    PROPERTIES: ClassVar[tuple[Property, ...]] = (*_depth_properties(), *CLOUD_PROPERTIES)

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._forget()

    def _forget(self) -> None:
        self._info: Any = None
        self._stamp_ns, self._frame = 0, ""
        self._pictures: deque[tuple[int, str, Received]] = deque(maxlen=100)
        self._chosen: Received | None = None
        self._occlusion = Occlusion()
        self._at: NDArray[np.float64] | None = None
        self._pinhole: Pinhole | None = None
        self._other_frame = False
        self._colour_fault = ""

    def roles(self) -> tuple[TopicRole, ...]:
        """Return the topics by the properties: that of the colours only where one is named."""
        depth, info, colour = self.TOPICS
        queue, values = int(self.values["Queue Size"]), self.values
        reliable = _RELIABLE[str(values["Reliability Policy"])]
        made = [
            _role(depth, str(values["Depth Map Transport Hint"]), queue, reliable=reliable),
            _role(info, "raw", queue, where=str(values["CameraInfo Topic"]).strip()),
        ]
        if where := str(values["Color Image Topic"]).strip():
            packed = str(values["Color Transport Hint"])
            made.append(_role(colour, packed, queue, reliable=reliable, where=where))
        return tuple(made)

    @property
    def wants_frames(self) -> bool:
        """To notice that the camera moved, so that what was hidden is forgotten."""
        return bool(self.values[_OCCLUSION])

    def see(self, frames: FramesNow) -> None:
        """Forget what was hidden if the camera moved."""
        pose = frames.pose_of(self._frame) if self._frame else None
        now = None if pose is None else np.array(pose)
        if now is not None and (self._at is None or has_moved(self._at, now)):
            self._at = now
            self._occlusion = Occlusion()

    def reset(self) -> None:
        """Forget all pictures and the calibration."""
        self._forget()
        super().reset()

    def changed(self, name: str) -> None:
        """Take new settings."""
        if name == _OCCLUSION:
            self._occlusion = Occlusion()
        if name in _AGAIN:
            self._pictures.clear()
            self._chosen = None
            self._colour_fault = ""
        super().changed(name)

    def take(self, received: Received, role: str = "") -> None:
        """Take a depth image, a picture or a calibration.

        Raises:
            StudioError: It cannot be read, or is no depth image.
        """
        if role == _INFO:
            self._take_info(received)
        elif role == _COLOUR:
            self._take_picture(received)
        else:
            super().take(received)

    def read(self, received: Received, limits: Limits) -> Cloud:
        """Return the points of a depth image by the calibration, which is there.

        Raises:
            DisplayMessageError: It is no depth image.
        """
        message = self.decode(received)
        depth = depth_of(message, received.type_name)
        self._stamp_ns, self._frame = stamp_ns_of(message.header), str(message.header.frame_id)
        self._choose()
        pinhole = pinhole_of(self._info, depth.size, "k") if self._info is not None else None
        self._pinhole = pinhole
        if pinhole is None:
            empty = np.empty((0, 3), np.float32)
            none = np.empty(0, np.float32)
            return Cloud(self._frame, self._stamp_ns, empty, None, 0, DepthFields(none, none))
        layers = [depth.depths_m]
        if self.values[_OCCLUSION]:
            timeout_s = float(self.values["Occlusion Compensation/Occlusion Time-Out"])
            layers.append(self._occlusion.hidden(depth.depths_m, received.received_ns, timeout_s))
        return self._cloud(np.stack(layers), depth.size, pinhole, limits)

    def _cloud(
        self,
        depths_m: NDArray[np.float32],
        size: tuple[int, int],
        pinhole: Pinhole,
        limits: Limits,
    ) -> Cloud:
        """Return the points of one image or two, (L, H, W), of which size was what was sent."""
        rows, columns = depths_m.shape[1:]
        flat = depths_m.reshape(-1)
        with np.errstate(invalid="ignore"):
            measured = np.isfinite(flat) & (flat > 0.0)
        chosen = evenly_among(measured, limits.points)
        v, u = np.divmod(chosen % (rows * columns), columns)
        column, row = _shares(u, columns, size[0]), _shares(v, rows, size[1])
        z = flat[chosen]
        x = (column * size[0] - pinhole.cx) * (z / pinhole.fx)
        y = (row * size[1] - pinhole.cy) * (z / pinhole.fy)
        places = np.stack((x, y, z), axis=1).astype(np.float32)
        fields = DepthFields(column, row)
        self._paint(fields)
        return Cloud(
            self._frame, self._stamp_ns, places, None,
            int(np.count_nonzero(measured)), fields, _nothing(int(chosen.size), flat.size),
        )  # fmt: skip

    def shape_of(self, cloud: Cloud, colours: NDArray[np.uint8], *, precise: bool) -> Points:
        """Return the points, each as large as its pixel if they size themselves."""
        points, pinhole = super().shape_of(cloud, colours, precise=precise), self._pinhole
        if not self.values[_AUTO_SIZE] or pinhole is None:
            return points
        size_m = float(self.values["Auto Size/Auto Size Factor"]) / pinhole.fx
        return replace(points, size_m=size_m, size_by_z=True)

    def statuses(self) -> tuple[Status, ...]:
        """Return why there are no points, or none in colours."""
        found: list[Status] = []
        is_there = self.newest_cloud is not None
        if is_there and self._pinhole is None:
            came = "has no focal length" if self._info is not None else "has not come"
            sentence = f"The camera info {came}: without it nobody knows where a depth is."
            return (Status("error", "no_camera_info", sentence),)
        if self._colour_fault:
            found.append(Status("warn", "bad_message", self._colour_fault))
        elif self._other_frame:
            sentence = "The picture is of another frame than the depths: its colours may be beside."
            found.append(Status("warn", None, sentence))
        elif is_there and self.values["Color Image Topic"] and not self._chosen:
            sentence = "No picture of the time of the depth image has come, so it has no colours."
            found.append(Status("warn", "no_picture", sentence))
        return (*super().statuses(), *found)

    def _take_info(self, received: Received) -> None:
        info = self.decode(received)
        with reading_fields(received.type_name):
            same = self._info is not None and calibration_of(info) == calibration_of(self._info)
        self._info = info
        if not same:
            self.read_again()

    def _take_picture(self, received: Received) -> None:
        message = self.decode(received)
        with reading_fields(received.type_name):
            stamp_ns, frame = stamp_ns_of(message.header), str(message.header.frame_id)
        while len(self._pictures) >= int(self.values["Queue Size"]):
            self._pictures.popleft()
        self._pictures.append((stamp_ns, frame, received))
        if self._choose():
            self._repaint()

    def _choose(self) -> bool:
        """Choose the picture nearest in time to the depth image; return whether it is another."""
        before = self._chosen
        nearest = min(self._pictures, key=lambda one: abs(one[0] - self._stamp_ns), default=None)
        if nearest is None or abs(nearest[0] - self._stamp_ns) > _APART_NS:
            self._chosen, self._other_frame = None, False
        else:
            self._chosen = nearest[2]
            self._other_frame = bool(self._frame) and nearest[1] != self._frame
        return self._chosen is not before

    def _repaint(self) -> None:
        """Give the newest points the colours of the picture that was chosen."""
        cloud = self.newest_cloud
        if cloud is not None and isinstance(cloud.channels, DepthFields):
            self._paint(cloud.channels)
            self.colour_again()

    def _paint(self, fields: DepthFields) -> None:
        self._colour_fault = ""
        fields.picture = None
        if self._chosen is None:
            return
        try:
            fields.picture = picture_of(self.decode(self._chosen), self._chosen.type_name)
        except StudioError as error:
            self._colour_fault = str(error)


def _role(
    role: TopicRole, transport: str, depth: int, *, reliable: bool | None = None, where: str = ""
) -> TopicRole:
    packed = "" if transport == "raw" else transport
    return replace(role, depth=depth, elsewhere=where, transport=packed, chosen_reliable=reliable)


def _shares(at: NDArray[np.intp], count: int, sent: int) -> NDArray[np.float32]:
    """Return columns of a thinned picture as shares of the whole one."""
    step = max(1, -(-sent // count))
    return (at * step / np.float32(sent)).astype(np.float32)


def depth_of(message: Any, type_name: str) -> _Depth:  # noqa: ANN401 - Image or CompressedImage
    """Return the depths of an image, m.

    Raises:
        DisplayMessageError: Its pixels are no depths: 16 bits hold mm, 32 bits m.
    """
    with reading_fields(type_name):
        pixels, size = read_pixels(message, type_name, PIXELS_MAX)
    if pixels.ndim != 2 or (pixels.dtype.kind, pixels.dtype.itemsize) not in {
        ("u", 2), ("f", 4), ("f", 8), ("i", 4),
    }:  # fmt: skip
        if not pixels.size:
            return _Depth(np.empty((0, 0), np.float32), size)
        encoding = str(getattr(message, "encoding", getattr(message, "format", "")))[:60]
        reason = f'its pixels are no depths but "{encoding}": 16UC1 and 32FC1 are'
        raise DisplayMessageError(type_name.rpartition("/")[2], reason)
    if pixels.dtype.kind == "f":
        return _Depth(pixels.astype(np.float32), size)
    return _Depth(pixels.astype(np.float32) * np.float32(_MM), size)


def picture_of(message: Any, type_name: str) -> NDArray[np.uint8] | None:  # noqa: ANN401
    """Return a picture in colours, shape (H, W, 3); None when it has no pixels.

    Raises:
        DisplayMessageError: It cannot be read, or holds numbers without a colour.
    """
    with reading_fields(type_name):
        pixels, _ = read_pixels(message, type_name, PIXELS_MAX)
    if not pixels.size:
        return None
    if pixels.ndim == 3:
        return pixels
    if pixels.dtype != np.uint8:
        kind = type_name.rpartition("/")[2]
        raise DisplayMessageError(kind, "its pixels are numbers without a colour")
    return np.repeat(pixels[..., None], 3, axis=2)


def has_moved(before: NDArray[np.float64], now: NDArray[np.float64]) -> bool:
    """Whether a pose (7,) is farther away than noise: as RViz, by 1 cm or half a degree."""
    if math.dist(before[4:], now[4:]) > 0.01:
        return True
    return math.degrees(angle_between_rad(before[:4], now[:4])) > 0.5


def _nothing(count: int, pixels: int) -> Status | None:
    if count:
        return None
    if not pixels:
        return Status("warn", "empty", "The depth image has no pixels.")
    return Status("warn", "not_finite", "Nothing was measured: all depths are 0, NaN or infinite.")
