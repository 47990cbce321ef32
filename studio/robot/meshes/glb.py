"""Writes a GLB: one node, one primitive per surface, images inside, nothing to fetch."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from studio.robot.meshes.surfaces import Appearance, bounds, linear_from_srgb, linear_shorts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from studio.robot.meshes.surfaces import Texture
    from studio.robot.meshes.welding import Welded

_MAGIC, _VERSION = 0x46546C67, 2
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942
_FLOAT, _UNSIGNED_SHORT, _UNSIGNED_INT = 5126, 5123, 5125
_VERTEX_BUFFER, _INDEX_BUFFER = 34962, 34963
_GREY = Appearance((0.7, 0.7, 0.7, 1.0))
_PAINTED = Appearance()
"""White, so that vertex colours show as they are."""


def write_glb(pieces: Sequence[tuple[Welded, Appearance | None]]) -> bytes:
    """Encode welded surfaces; one without an appearance is drawn light grey."""
    writer = _Writer()
    for welded, appearance in pieces:
        writer.add(welded, appearance)
    return writer.encode()


class _Writer:
    """Collects buffer views, accessors, images and materials as glTF 2.0 numbers them."""

    def __init__(self) -> None:
        self._chunks: list[bytes] = []
        self._length = 0
        self._views: list[dict[str, Any]] = []
        self._accessors: list[dict[str, Any]] = []
        self._images: dict[bytes, int] = {}
        self._image_entries: list[dict[str, Any]] = []
        self._materials: list[dict[str, Any]] = []
        self._known_appearances: dict[Appearance | None, int] = {}
        self._primitives: list[dict[str, Any]] = []

    def add(self, welded: Welded, appearance: Appearance | None) -> None:
        """Add one primitive."""
        attributes = {
            "POSITION": self._accessor(welded.vertices, "VEC3", bounded=True),
            "NORMAL": self._accessor(welded.normals, "VEC3"),
        }
        if welded.uv is not None:
            # glTF counts v downwards from the upper edge
            downwards = welded.uv.copy()
            downwards[:, 1] = 1 - downwards[:, 1]
            attributes["TEXCOORD_0"] = self._accessor(downwards, "VEC2")
        if welded.colors is not None:
            attributes["COLOR_0"] = self._accessor(linear_shorts(welded.colors), "VEC4")
        self._primitives.append(
            {
                "attributes": attributes,
                "indices": self._indices(welded.faces),
                "material": self._material(appearance, welded.colors),
            }
        )

    def encode(self) -> bytes:
        """Return the whole file."""
        document: dict[str, Any] = {
            "asset": {"version": "2.0", "generator": "robot description studio"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": self._primitives}],
            "materials": self._materials,
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": self._length}],
        }
        if self._image_entries:
            document["images"] = self._image_entries
            document["samplers"] = [{"wrapS": 10497, "wrapT": 10497}]
            document["textures"] = [
                {"source": index, "sampler": 0} for index in range(len(self._image_entries))
            ]
        text = msgspec.json.encode(document)
        text += b" " * (-len(text) % 4)
        binary = b"".join(self._chunks)
        head = struct.pack("<III", _MAGIC, _VERSION, 12 + 8 + len(text) + 8 + len(binary))
        chunks = (
            struct.pack("<II", len(text), _JSON_CHUNK),
            text,
            struct.pack("<II", len(binary), _BINARY_CHUNK),
            binary,
        )
        return head + b"".join(chunks)

    def _view(self, data: bytes, target: int | None = None) -> int:
        view: dict[str, Any] = {"buffer": 0, "byteOffset": self._length, "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self._views.append(view)
        padded = data + b"\0" * (-len(data) % 4)
        self._chunks.append(padded)
        self._length += len(padded)
        return len(self._views) - 1

    def _accessor(
        self, rows: NDArray[np.float32] | NDArray[np.uint16], kind: str, *, bounded: bool = False
    ) -> int:
        accessor: dict[str, Any] = {
            "bufferView": self._view(np.ascontiguousarray(rows).tobytes(), _VERTEX_BUFFER),
            "componentType": _FLOAT if rows.dtype == np.float32 else _UNSIGNED_SHORT,
            "count": len(rows),
            "type": kind,
        }
        if rows.dtype == np.uint16:
            accessor["normalized"] = True
        if bounded:
            accessor["min"], accessor["max"] = bounds(rows.astype(np.float32, copy=False))
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def _indices(self, faces: NDArray[np.uint32]) -> int:
        short = int(faces.max(initial=0)) < 0xFFFF
        data = faces.astype(np.uint16).tobytes() if short else faces.tobytes()
        self._accessors.append(
            {
                "bufferView": self._view(data, _INDEX_BUFFER),
                "componentType": _UNSIGNED_SHORT if short else _UNSIGNED_INT,
                "count": faces.size,
                "type": "SCALAR",
            }
        )
        return len(self._accessors) - 1

    def _material(self, appearance: Appearance | None, colors: NDArray[np.uint8] | None) -> int:
        key = appearance if appearance is not None or colors is None else _PAINTED
        if key not in self._known_appearances:
            self._known_appearances[key] = len(self._materials)
            self._materials.append(self._encode_appearance(key))
        return self._known_appearances[key]

    def _encode_appearance(self, appearance: Appearance | None) -> dict[str, Any]:
        shown = _GREY if appearance is None else appearance
        surface: dict[str, Any] = {
            "baseColorFactor": [*map(linear_from_srgb, shown.rgba[:3]), shown.rgba[3]],
            "metallicFactor": shown.metallic,
            "roughnessFactor": shown.roughness,
        }
        if shown.texture is not None:
            surface["baseColorTexture"] = {"index": self._image(shown.texture)}
        # both sides: many makers' triangles face inwards, and RViz shows them all the same
        material: dict[str, Any] = {"pbrMetallicRoughness": surface, "doubleSided": True}
        if shown.rgba[3] < 1.0:
            material["alphaMode"] = "BLEND"
        return material

    def _image(self, texture: Texture) -> int:
        if texture.data not in self._images:
            self._images[texture.data] = len(self._image_entries)
            view = self._view(texture.data)
            self._image_entries.append({"bufferView": view, "mimeType": texture.mime})
        return self._images[texture.data]
