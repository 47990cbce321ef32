"""Surfaces of triangles as nodes: in one colour a mesh, else a small GLB with colours in it."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from viser import _messages

from studio.scene import node
from studio.scene.node import Node, Style

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.drawing import Triangles

_MAGIC, _JSON, _BINARY = b"glTF", b"JSON", b"BIN\0"
_FLOAT, _UINT32, _UINT16 = 5126, 5125, 5123
_VERTICES, _INDICES = 34962, 34963
_FULL: Final = 65535
"""Colours have 16 bits for each part: as amounts of light, 8 are too few where it is dark."""


def surface_of(shape: Triangles, stream: str) -> dict[str, Node]:
    """Return a node, or None without triangles; those without all their corners are skipped."""
    vertices = np.ascontiguousarray(shape.vertices, np.float32)
    faces, drawn = np.ascontiguousarray(shape.faces, np.uint32), drawn_faces(shape)
    faces = faces if len(drawn) == len(faces) else faces[drawn]
    if len(faces) == 0:
        return {}
    if shape.colors.ndim == 1:
        return {"surface": _plain(vertices, faces, shape, stream)}
    data = np.frombuffer(glb_of(vertices, faces, shape.colors), np.uint8)
    props: dict[str, Any] = {
        "scale": 1.0,
        "cast_shadow": False,
        "receive_shadow": False,
        "studio_opacity": shape.opacity,
    }
    flowing: dict[str, NDArray[Any]] = {"glb_data": data}
    return {"colored": Node(_messages.GlbMessage, props, stream=stream, flowing=flowing)}


def drawn_faces(shape: Triangles) -> NDArray[np.intp]:
    """Return the rows of the triangles that have all their corners, ascending."""
    finite = np.isfinite(shape.vertices)
    if len(shape.faces) and int(shape.faces.max()) < len(finite) and finite.all():
        return np.arange(len(shape.faces))
    known = np.flatnonzero((shape.faces < len(finite)).all(axis=1))
    somewhere: NDArray[np.bool_] = np.logical_and.reduce(finite, axis=1)
    return known[somewhere[shape.faces[known]].all(axis=1)]


def _plain(
    vertices: NDArray[np.float32], faces: NDArray[np.uint32], shape: Triangles, stream: str
) -> Node:
    red, green, blue = shape.colors.tolist()
    style = Style((red, green, blue), shape.opacity, shadow=False)
    props = {**node.surface(style), "side": "double", "flat_shading": True}
    arrays: dict[str, NDArray[Any]] = {"vertices": vertices, "faces": faces}
    return Node(_messages.MeshMessage, props, stream=stream, flowing=arrays)


def glb_of(
    vertices: NDArray[np.float32], faces: NDArray[np.uint32], colors: NDArray[np.uint8]
) -> bytes:
    """Return a glTF 2.0 of one mesh that is seen from both sides.

    Args:
        vertices: Shape (V, 3), m.
        faces: Shape (F, 3).
        colors: Shape (V, 3), sRGB.
    """
    light = np.full((len(vertices), 4), _FULL, np.uint16)
    shown = colors / np.float32(255)
    linear = np.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
    light[:, :3] = np.round(linear * _FULL)
    parts = [vertices.tobytes(), light.tobytes(), faces.tobytes()]
    head = json.dumps(_head(vertices, faces, parts)).encode()
    head += b" " * (-len(head) % 4)
    body = b"".join(parts)
    size = 12 + 8 + len(head) + 8 + len(body)
    return b"".join(
        (
            _MAGIC,
            _u32(2),
            _u32(size),
            *(_u32(len(head)), _JSON, head),
            *(_u32(len(body)), _BINARY, body),
        )
    )


def _u32(value: int) -> bytes:
    return value.to_bytes(4, "little")


def _head(
    vertices: NDArray[np.float32], faces: NDArray[np.uint32], parts: list[bytes]
) -> dict[str, Any]:
    starts = np.cumsum([0, *map(len, parts)]).tolist()
    targets = (_VERTICES, _VERTICES, _INDICES)
    finite = vertices[np.isfinite(vertices).all(axis=1)]
    low, high = (finite.min(axis=0), finite.max(axis=0)) if len(finite) else (np.zeros(3),) * 2
    count = len(vertices)
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [
            {
                "primitives": [
                    {"attributes": {"POSITION": 0, "COLOR_0": 1}, "indices": 2, "material": 0}
                ]
            }
        ],
        "materials": [
            {
                "doubleSided": True,
                "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": 1.0},
            }
        ],
        "buffers": [{"byteLength": starts[-1]}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": start, "byteLength": len(part), "target": target}
            for start, part, target in zip(starts, parts, targets, strict=False)
        ],
        "accessors": [
            {
                **_accessor(0, _FLOAT, "VEC3", count),
                "min": low.tolist(),
                "max": high.tolist(),
            },
            {**_accessor(1, _UINT16, "VEC4", count), "normalized": True},
            _accessor(2, _UINT32, "SCALAR", faces.size),
        ],
    }


def _accessor(view: int, component: int, kind: str, count: int) -> dict[str, Any]:
    return {"bufferView": view, "componentType": component, "type": kind, "count": count}
