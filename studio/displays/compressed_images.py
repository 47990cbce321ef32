"""Compressed images: JPEG and PNG, also of depths. The door of displays to Pillow."""

from __future__ import annotations

import io
import warnings
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from studio.displays.image_encodings import step_for
from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PIL import Image

_FORMATS: Final = ("JPEG", "PNG", "WEBP", "BMP", "TIFF")
_PIXELS_MAX: Final = 64 << 20
_DEPTH: Final = "compressedDepth"
_PNG: Final = b"\x89PNG"
# What compressed_depth_image_transport puts before its PNG: an enum and two floats.
_HEADER_BYTES: Final = 12


def read_compressed(message: Any, pixels_max: int) -> NDArray[Any]:  # noqa: ANN401
    """The pixels of a sensor_msgs/CompressedImage, thinned where there are too many.

    Returns:
        Shape (H, W, 3), uint8, colours; or (H, W), numbers without a colour.

    Raises:
        DisplayMessageError: It is no picture, of another kind, or too large.
    """
    said = str(message.format)
    if _DEPTH in said:
        return _depths(message.data, said, pixels_max)
    return _unpacked(message.data, said, pixels_max)


def _unpacked(data: NDArray[np.uint8], said: str, pixels_max: int) -> NDArray[Any]:
    from PIL import Image  # noqa: PLC0415 - most robots are looked at without

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(data.tobytes()), formats=_FORMATS) as image:
                return _pixels(image, pixels_max)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError, Warning) as error:
        raise _error(f'its data is no JPEG or PNG (format "{said[:60]}"): {error}') from None


def _depths(data: NDArray[np.uint8], said: str, pixels_max: int) -> NDArray[Any]:
    """Depths from a PNG after a header; of floats it holds the inverse, in steps."""
    if bytes(data[_HEADER_BYTES : _HEADER_BYTES + 4]) != _PNG:
        raise _error(f'depths are read from PNG, and its format is "{said[:60]}"')
    steps = _unpacked(data[_HEADER_BYTES:], said, pixels_max)
    if not said.startswith("32FC1") or steps.ndim != 2:
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
