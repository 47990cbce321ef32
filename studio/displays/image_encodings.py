"""Pixels of images: of raw ones in any encoding, and of JPEG and PNG. Displays' door to Pillow."""

from __future__ import annotations

import io
import warnings
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import numpy as np

from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray
    from PIL import Image

Reader: TypeAlias = "Callable[[Raw], NDArray[Any]]"

IMAGE: Final = "sensor_msgs/msg/Image"
COMPRESSED: Final = "sensor_msgs/msg/CompressedImage"
_SIDE_MAX: Final = 65_536
# Full range BT.601, as cameras send it over USB: red and blue from the two differences.
_RED_OF_V, _GREEN_OF_U, _GREEN_OF_V, _BLUE_OF_U = 1.402, -0.344136, -0.714136, 1.772
# Where red is in a square of 2 x 2 pixels, row and column; blue is across, green in the others.
_RED_AT: Final = {"rggb": (0, 0), "grbg": (0, 1), "gbrg": (1, 0), "bggr": (1, 1)}
_TYPES: Final = {
    "8U": "u1", "8S": "i1", "16U": "u2", "16S": "i2", "32S": "i4", "32F": "f4", "64F": "f8",
}  # fmt: skip
_FORMATS: Final = ("JPEG", "PNG", "WEBP", "BMP", "TIFF")
_PIXELS_MAX: Final = 64 << 20
_DEPTH: Final = "compressedDepth"
_PNG: Final = b"\x89PNG"
# What compressed_depth_image_transport puts before its PNG: an enum and two floats.
_HEADER_BYTES: Final = 12


class Raw:
    """The bytes of a sensor_msgs/Image with its size, and every how many-th pixel is wanted."""

    def __init__(self, message: Any, pixels_max: int) -> None:  # noqa: ANN401
        self.width, self.height = int(message.width), int(message.height)
        self.row_bytes = int(message.step)
        self.encoding = str(message.encoding)
        self.order = ">" if message.is_bigendian else "<"
        self.data: NDArray[np.uint8] = message.data
        if max(self.width, self.height) > _SIDE_MAX:
            raise self.error(f"it is {self.width:,} x {self.height:,} pixels large")
        self.step = step_for(self.width * self.height, pixels_max)

    def view(self, numbers: str, channels: int, *, thinned: bool = True) -> NDArray[Any]:
        """Pixels of one type, shape (rows, columns, channels); thinned: as many as are wanted.

        Raises:
            DisplayMessageError: The data does not hold them.
        """
        dtype = np.dtype(self.order + numbers)
        pixel = dtype.itemsize * channels
        row = self.row_bytes or self.width * pixel
        needed = (self.height - 1) * row + self.width * pixel if self.height else 0
        if row < self.width * pixel or needed > self.data.nbytes:
            raise self.error(
                f"{self.width:,} x {self.height:,} pixels of {pixel} bytes need {needed:,} bytes "
                f"in rows of {row:,}, and it has {self.data.nbytes:,}"
            )
        whole: NDArray[Any] = np.ndarray(
            (self.height, self.width, channels), dtype, self.data, 0,
            (row, pixel, dtype.itemsize),
        )  # fmt: skip
        return whole[:: self.step, :: self.step] if thinned else whole

    def error(self, reason: str) -> DisplayMessageError:
        """Refuse the image."""
        return DisplayMessageError("Image", reason)


def step_for(count: int, limit: int) -> int:
    """Return every how many-th row and column is taken, so that the limit holds."""
    return max(1, int(np.ceil(np.sqrt(count / max(limit, 1)))))


def read_pixels(
    message: Any,  # noqa: ANN401 - of the type that is named
    type_name: str,
    pixels_max: int,
) -> tuple[NDArray[Any], tuple[int, int]]:
    """Return the pixels of an image of either type, as below, and its width and height.

    Those are as it was sent; of a compressed one, which may be thinned, as it was read.
    """
    if type_name == COMPRESSED:
        pixels = read_compressed(message, pixels_max)
        return pixels, (pixels.shape[1], pixels.shape[0])
    return read_image(message, pixels_max), (int(message.width), int(message.height))


def read_image(message: Any, pixels_max: int) -> NDArray[Any]:  # noqa: ANN401 - sensor_msgs/Image
    """Return the pixels of a raw image, thinned where there are too many.

    Returns:
        Shape (H, W, 3), uint8, colours; or (H, W), of the image's own type, numbers without a
        colour as depths. Neither has a pixel when the image has none.

    Raises:
        DisplayMessageError: The encoding is not known, or the data does not hold the pixels.
    """
    raw = Raw(message, pixels_max)
    reader = _READERS.get(raw.encoding) or _generic(raw)
    if not raw.width * raw.height:
        return np.empty((0, 0, 3), dtype=np.uint8)
    return reader(raw)


def _colours(order: str, *, numbers: str = "u1") -> Reader:
    """Channels by their letters."""

    def read(raw: Raw) -> NDArray[np.uint8]:
        pixels = raw.view(numbers, len(order))
        if order == "rgb":
            chosen = pixels
        else:
            chosen = pixels[..., [order.index(letter) for letter in "rgb"]]
        return _as_bytes(chosen)

    return read


def _grey(numbers: str) -> Reader:
    def read(raw: Raw) -> NDArray[Any]:
        return _native(raw.view(numbers, 1)[..., 0])

    return read


def _yuv(luma: int) -> Reader:
    """Two bytes for each pixel; pairs share the differences. `luma`: where the first brightness is.

    `uyvy` is U Y V Y, `yuyv` Y U Y V.
    """

    def read(raw: Raw) -> NDArray[np.uint8]:
        chroma = 1 - luma
        whole = raw.view("u1", 2, thinned=False)
        pairs = raw.width // 2
        columns = np.arange(0, pairs * 2, raw.step)
        rows = whole[:: raw.step]
        y = rows[:, columns, luma].astype(np.float32)
        u = rows[:, columns // 2 * 2, chroma].astype(np.float32) - 128.0
        v = rows[:, columns // 2 * 2 + 1, chroma].astype(np.float32) - 128.0
        return _rgb_of_yuv(y, u, v)

    return read


def _planar(first: int) -> Reader:
    """A plane of brightness, and below it one of half the size with both differences in turns.

    `nv12` has U first, `nv21` V.
    """

    def read(raw: Raw) -> NDArray[np.uint8]:
        row = raw.row_bytes or raw.width
        lines = raw.height + raw.height // 2
        if row < raw.width or lines * row > raw.data.nbytes:
            raise raw.error(f"its {raw.data.nbytes:,} bytes are fewer than {lines} rows of {row}")
        planes = raw.data[: lines * row].reshape(lines, row)
        y_rows = np.arange(0, raw.height // 2 * 2, raw.step)
        columns = np.arange(0, raw.width // 2 * 2, raw.step)
        y = planes[y_rows][:, columns].astype(np.float32)
        below = planes[raw.height + y_rows // 2].astype(np.float32) - 128.0
        pair = below[:, columns // 2 * 2], below[:, columns // 2 * 2 + 1]
        return _rgb_of_yuv(y, pair[first], pair[1 - first])

    return read


def _bayer(pattern: str, numbers: str) -> Reader:
    """Read one pixel of each square of 2 x 2: pictures are drawn small, and nothing is guessed."""
    red_row, red_column = _RED_AT[pattern]

    def read(raw: Raw) -> NDArray[np.uint8]:
        whole = raw.view(numbers, 1, thinned=False)[..., 0]
        rows, columns = raw.height // 2 * 2, raw.width // 2 * 2
        step = 2 * -(-raw.step // 2)

        def at(row: int, column: int) -> NDArray[Any]:
            return whole[row:rows:step, column:columns:step]

        greens = np.stack([at(red_row, 1 - red_column), at(1 - red_row, red_column)])
        green = _as_bytes(greens).astype(np.uint16).sum(axis=0) // 2
        red = _as_bytes(at(red_row, red_column))
        blue = _as_bytes(at(1 - red_row, 1 - red_column))
        return np.stack([red, green.astype(np.uint8), blue], axis=-1)

    return read


def _generic(raw: Raw) -> Reader:
    """OpenCV's names, as 16UC1: one channel is numbers, three are blue, green and red."""
    depth, _, channels = raw.encoding.partition("C")
    numbers = _TYPES.get(depth)
    if numbers is not None and channels in ("", "1"):
        return _grey(numbers)
    if numbers in ("u1", "u2") and channels in ("3", "4"):
        return _colours("bgra"[: int(channels)], numbers=numbers)
    raise raw.error(
        f'its encoding "{raw.encoding[:60]}" is not known: known are {", ".join(sorted(_READERS))}'
        ", 8UC1 to 64FC1, 8UC3, 8UC4, 16UC3 and 16UC4"
    )


def _rgb_of_yuv(
    y: NDArray[np.float32], u: NDArray[np.float32], v: NDArray[np.float32]
) -> NDArray[np.uint8]:
    red = y + _RED_OF_V * v
    green = y + _GREEN_OF_U * u + _GREEN_OF_V * v
    blue = y + _BLUE_OF_U * u
    return np.clip(np.rint(np.stack([red, green, blue], axis=-1)), 0, 255).astype(np.uint8)


def _as_bytes(pixels: NDArray[Any]) -> NDArray[np.uint8]:
    """Brightness of a byte; of two bytes the upper one counts."""
    if pixels.dtype.itemsize == 2:
        return (pixels >> 8).astype(np.uint8)
    return np.ascontiguousarray(pixels)


def _native(numbers: NDArray[Any]) -> NDArray[Any]:
    return numbers.astype(numbers.dtype.newbyteorder("="), order="C")


_READERS: Final[dict[str, Reader]] = {
    "rgb8": _colours("rgb"),
    "bgr8": _colours("bgr"),
    "rgba8": _colours("rgba"),
    "bgra8": _colours("bgra"),
    "rgb16": _colours("rgb", numbers="u2"),
    "bgr16": _colours("bgr", numbers="u2"),
    "rgba16": _colours("rgba", numbers="u2"),
    "bgra16": _colours("bgra", numbers="u2"),
    "mono8": _grey("u1"),
    "mono16": _grey("u2"),
    "uyvy": _yuv(1),
    "yuv422": _yuv(1),
    "yuyv": _yuv(0),
    "yuv422_yuy2": _yuv(0),
    "nv12": _planar(0),
    "nv21": _planar(1),
    **{f"bayer_{pattern}8": _bayer(pattern, "u1") for pattern in _RED_AT},
    **{f"bayer_{pattern}16": _bayer(pattern, "u2") for pattern in _RED_AT},
}


def read_compressed(message: Any, pixels_max: int) -> NDArray[Any]:  # noqa: ANN401
    """Return the pixels of a sensor_msgs/CompressedImage, thinned where there are too many.

    Returns:
        Shape (H, W, 3), uint8, colours; or (H, W), numbers without a colour.

    Raises:
        DisplayMessageError: It is no picture, of another kind, or too large.
    """
    format_name = str(message.format)
    if _DEPTH in format_name:
        return _depths(message.data, format_name, pixels_max)
    return _unpacked(message.data, format_name, pixels_max)


def _unpacked(data: NDArray[np.uint8], format_name: str, pixels_max: int) -> NDArray[Any]:
    from PIL import Image  # noqa: PLC0415 - seldom needed

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(data.tobytes()), formats=_FORMATS) as image:
                return _pixels(image, pixels_max)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError, Warning) as error:
        raise _error(f'its data is no JPEG or PNG (format "{format_name[:60]}"): {error}') from None


def _depths(data: NDArray[np.uint8], format_name: str, pixels_max: int) -> NDArray[Any]:
    """Depths from a PNG after a header; of floats it holds the inverse, in steps."""
    if bytes(data[_HEADER_BYTES : _HEADER_BYTES + 4]) != _PNG:
        raise _error(f'depths are read from PNG, and its format is "{format_name[:60]}"')
    steps = _unpacked(data[_HEADER_BYTES:], format_name, pixels_max)
    if not format_name.startswith("32FC1") or steps.ndim != 2:
        return steps
    near, far = np.frombuffer(bytes(data[4:_HEADER_BYTES]), dtype="<f4")
    with np.errstate(all="ignore"):
        depths = near / (steps.astype(np.float32) - far)
    return np.where(steps > 0, depths, np.float32("nan"))


def _pixels(image: Image.Image, pixels_max: int) -> NDArray[Any]:
    width, height = image.size
    if width * height > _PIXELS_MAX:
        raise _error(f"it is {width:,} x {height:,} pixels large")
    step = step_for(width * height, pixels_max)
    # JPEG is unpacked at a half or a quarter of its size far quicker than as a whole.
    image.draft("RGB" if image.mode != "L" else "L", (-(-width // step), -(-height // step)))
    if image.mode not in ("L", "I", "F") and not image.mode.startswith("I;16"):
        image = image.convert("RGB")
    pixels = np.asarray(image)
    step = step_for(pixels.shape[0] * pixels.shape[1], pixels_max)
    return np.ascontiguousarray(pixels[::step, ::step])


def _error(reason: str) -> DisplayMessageError:
    return DisplayMessageError("CompressedImage", reason.rstrip("."))
