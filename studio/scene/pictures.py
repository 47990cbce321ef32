"""Pictures in the scene: maps in tiles, of which only changed ones are encoded and sent."""

from __future__ import annotations

import io
import zlib
from collections import OrderedDict
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import xxhash
from PIL import Image
from viser import _messages

from studio.scene.node import Node
from studio.tf.rotations import turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import CameraView, Frustum, Picture

_SIGNATURE: Final = b"\x89PNG\r\n\x1a\n"
_DEPTH, _INDEXED = 8, 3
_QUICKLY: Final = 1
TILE_PX: Final = 1024
"""Edge of a tile: a robot that maps a hall changes one or two of them at a time."""
_KEPT_BYTES: Final = 32 << 20
_FRUSTUM_PX: Final = 1024
"""A camera's picture in the scene is not made larger than this; its panel shows it whole."""
_JPEG_QUALITY: Final = 82
_EDGE_PX: Final = 1.5


def indexed_png(pixels: NDArray[np.uint8], palette: NDArray[np.uint8]) -> bytes:
    """Pack pixels (PNG, second edition: 11.2 and 11.3.2).

    Args:
        pixels: Shape (H, W): each the row of its colour.
        palette: Shape (N, 4), N of 256 at most, RGBA.
    """
    rows, columns = pixels.shape
    # Before each row stands how it was filtered: not at all.
    lines = np.zeros((rows, columns + 1), np.uint8)
    lines[:, 1:] = pixels
    head = columns.to_bytes(4, "big") + rows.to_bytes(4, "big")
    return b"".join(
        (
            _SIGNATURE,
            _chunk(b"IHDR", head + bytes((_DEPTH, _INDEXED, 0, 0, 0))),
            _chunk(b"PLTE", palette[:, :3].tobytes()),
            _chunk(b"tRNS", palette[:, 3].tobytes()),
            _chunk(b"IDAT", zlib.compress(lines.data, _QUICKLY)),
            _chunk(b"IEND", b""),
        )
    )


def _chunk(name: bytes, data: bytes) -> bytes:
    check = zlib.crc32(data, zlib.crc32(name))
    return len(data).to_bytes(4, "big") + name + data + check.to_bytes(4, "big")


class EncodedShelf:
    """Encoded pictures by the digest of their pixels, the newest used last; bounded."""

    def __init__(self) -> None:
        self._encoded: OrderedDict[str, NDArray[np.uint8]] = OrderedDict()
        self.kept_bytes = 0

    def png(
        self, pixels: NDArray[np.uint8], digest: str, palette: NDArray[np.uint8] | None = None
    ) -> NDArray[np.uint8]:
        """Return a PNG, made if it is not there.

        Args:
            pixels: Shape (H, W, 4), RGBA; or (H, W), rows of the palette.
            digest: Of these very pixels, their shape and the palette.
            palette: Shape (256, 4), RGBA.
        """
        found = self._encoded.get(digest)
        if found is None:
            found = _png(pixels, palette)
            self._encoded[digest] = found
            self.kept_bytes += found.nbytes
        self._encoded.move_to_end(digest)
        while self.kept_bytes > _KEPT_BYTES and len(self._encoded) > 1:
            self.kept_bytes -= self._encoded.popitem(last=False)[1].nbytes
        return found


def _png(pixels: NDArray[np.uint8], palette: NDArray[np.uint8] | None) -> NDArray[np.uint8]:
    if palette is None:
        return _encoded(pixels, "PNG", compress_level=1)
    return np.frombuffer(indexed_png(pixels, palette), np.uint8)


def _encoded(pixels: NDArray[np.uint8], kind: str, **options: int) -> NDArray[np.uint8]:
    file = io.BytesIO()
    Image.fromarray(np.ascontiguousarray(pixels)).save(file, kind, **options)
    return np.frombuffer(file.getvalue(), np.uint8)


def tiles_of(shape: Picture, shelf: EncodedShelf) -> dict[str, Node]:
    """Return a picture as nodes, by row and column of each tile."""
    rows, columns = shape.pixels.shape[:2]
    return {
        f"{row // TILE_PX}-{column // TILE_PX}": _tile(shape, row, column, shelf)
        for row in range(0, rows, TILE_PX)
        for column in range(0, columns, TILE_PX)
    }


def _tile(shape: Picture, row: int, column: int, shelf: EncodedShelf) -> Node:
    pixels = np.ascontiguousarray(shape.pixels[row : row + TILE_PX, column : column + TILE_PX])
    rows, columns = pixels.shape[:2]
    colours = b"" if shape.palette is None else shape.palette.tobytes()
    digest = (
        f"{xxhash.xxh3_128_hexdigest(pixels.data)}/{columns}/{xxhash.xxh3_64_hexdigest(colours)}"
    )
    x_m, y_m = (
        size_m / count
        for size_m, count in zip(shape.size_m, reversed(shape.pixels.shape[:2]), strict=True)
    )
    centre = turned(shape.wxyz, (column + columns / 2) * x_m, (row + rows / 2) * y_m, 0.0)
    at = tuple(a + b for a, b in zip(shape.position, centre, strict=True))
    props: dict[str, Any] = {
        "_format": "png",
        "render_width": columns * x_m,
        "render_height": rows * y_m,
        "cast_shadow": False,
        "receive_shadow": False,
        "scale": 1.0,
        "studio_sharp": True,
        "studio_behind": shape.behind,
    }
    data: dict[str, NDArray[Any]] = {"_data": shelf.png(pixels, digest, shape.palette)}
    return Node(
        _messages.ImageMessage,
        props,
        shape.wxyz,
        (at[0], at[1], at[2]),
        stream=digest,
        flowing=data,
    )


def frustum_of(shape: Frustum, stream: str) -> Node:
    """Return the edges of what a camera sees, and its picture at their far end."""
    fov_rad = min(max(shape.fov_y_rad, 1e-3), np.pi - 1e-3)
    half_y = float(np.tan(fov_rad / 2))
    # viser draws a pyramid of volume 1/3 for scale 1; ours is as long as the message has it.
    long_for_one = 1 / np.cbrt(half_y * half_y * shape.aspect / 3)
    props: dict[str, Any] = {
        "fov": float(fov_rad),
        "aspect": shape.aspect,
        "thickness": _EDGE_PX,
        "thickness_units": "screen",
        "color": shape.rgb,
        "_format": "jpeg",
        "cast_shadow": False,
        "receive_shadow": False,
        "variant": "wireframe",
        "scale": float(shape.far_m / long_for_one),
        "studio_opacity": shape.opacity,
    }
    if shape.image is None:
        return Node(_messages.CameraFrustumMessage, {**props, "_image_data": None})
    data: dict[str, NDArray[Any]] = {"_image_data": _jpeg(shape.image)}
    return Node(_messages.CameraFrustumMessage, props, stream=stream, flowing=data)


def camera_of(shape: CameraView, stream: str) -> Node:
    """Return the view of a camera: the page takes its picture out, and nothing else is seen."""
    props: dict[str, Any] = {
        "fov": 1.0,
        "aspect": 1.0,
        "thickness": _EDGE_PX,
        "thickness_units": "screen",
        "color": (0, 0, 0),
        "_format": "jpeg",
        "cast_shadow": False,
        "receive_shadow": False,
        "variant": "wireframe",
        "scale": 1e-6,
        "studio_camera": {
            "lens": None if shape.lens is None else list(shape.lens),
            "rendering": shape.rendering,
            "overlay_alpha": shape.overlay_alpha,
            "zoom": shape.zoom,
            "near_m": shape.near_m,
            "far_m": shape.far_m,
            "hidden": list(shape.hidden),
        },
    }
    data: dict[str, NDArray[Any]] = {"_image_data": _jpeg(shape.image)}
    kind = _messages.CameraFrustumMessage
    return Node(kind, props, visible=False, stream=stream, flowing=data)


def _jpeg(image: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return a picture of bounded size: every second pixel of a large one, or every third, ..."""
    step = -(-max(image.shape[:2]) // _FRUSTUM_PX)
    return _encoded(image[::step, ::step], "JPEG", quality=_JPEG_QUALITY)
