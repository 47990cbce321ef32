# pyright: reportUnknownMemberType=false
"""Images for meshes: PNG and JPEG pass as they are, others become PNG. The door to Pillow."""

from __future__ import annotations

import io
import warnings
from typing import TYPE_CHECKING, Final

from studio.errors import MeshError
from studio.robot.surfaces import Texture

if TYPE_CHECKING:
    from PIL import Image

    from studio.robot.mesh_files import MeshFiles

_PASSED: Final = {"PNG": "image/png", "JPEG": "image/jpeg"}
_FORMATS: Final = ("PNG", "JPEG", "BMP", "TGA", "TIFF", "GIF", "WEBP", "PPM")
_SIDE_LIMIT: Final = 8192
_PIXEL_LIMIT: Final = 64 << 20


def read_texture(files: MeshFiles, uri: str) -> Texture | None:
    """The image that a mesh refers to; None, and a warning, when it cannot be had."""
    try:
        return encode_texture(files, uri, files.read_beside(uri))
    except MeshError as error:
        files.warn("missing-texture", f"{error.reason} The mesh is drawn without it.")
        return None


def encode_texture(files: MeshFiles, name: str, data: bytes) -> Texture | None:
    """An image as browsers know it; None, and a warning, when it is broken or too large.

    Only the header of PNG and JPEG is looked at: its size decides what unpacking would cost.
    """
    from PIL import Image  # noqa: PLC0415 - many meshes have no texture

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(data), formats=_FORMATS) as image:
                width, height = image.size
                if max(width, height) > _SIDE_LIMIT or width * height > _PIXEL_LIMIT:
                    files.warn("bad-texture", _too_large(name, width, height))
                    return None
                return _encode(image, data)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError, Warning) as error:
        files.warn("bad-texture", f'its texture "{name}" is no image that can be read ({error}).')
        return None


def _encode(image: Image.Image, data: bytes) -> Texture:
    mime = _PASSED.get(image.format or "")
    if mime is not None and image.mode != "CMYK":
        return Texture(data, mime)
    buffer = io.BytesIO()
    image.convert("RGBA").save(buffer, "PNG", compress_level=1)
    return Texture(buffer.getvalue(), "image/png")


def _too_large(name: str, width: int, height: int) -> str:
    return (
        f'its texture "{name}" is {width} x {height} pixels, more than {_SIDE_LIMIT} a side: '
        "scale it down. The mesh is drawn without it."
    )
