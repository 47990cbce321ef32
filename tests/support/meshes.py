"""Small mesh files of every format that is read, whole and hostile."""

from __future__ import annotations

import io
import json
import struct
import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

from studio.robot.meshes.files import MeshFiles
from studio.robot.meshes.reading import read_mesh

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from studio.robot.meshes.loaded_mesh import LoadedMesh

TETRAHEDRON = np.array(
    [[[0, 0, 0], [0, 1, 0], [1, 0, 0]], [[0, 0, 0], [0, 0, 1], [0, 1, 0]],
     [[0, 0, 0], [1, 0, 0], [0, 0, 1]], [[1, 0, 0], [0, 1, 0], [0, 0, 1]]],
    dtype=np.float64,
)  # fmt: skip
"""Four triangles, outside out, in [0, 1]."""


def read(path: Path, data: bytes | str, *roots: Path) -> LoadedMesh:
    """Write a mesh file and read it as the worker does."""
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    return read_mesh(MeshFiles(path, roots))


def stl(triangles: NDArray[np.float64] = TETRAHEDRON, told: int | None = None) -> bytes:
    """A binary STL; `told` is what its header says when that is a lie."""
    head = b"made by a test".ljust(80) + struct.pack("<I", len(triangles) if told is None else told)
    with np.errstate(invalid="ignore"):
        corners = triangles.astype("<f4")
    return head + b"".join(struct.pack("<3f", 0, 0, 0) + one.tobytes() + b"\0\0" for one in corners)


def stl_text(triangles: NDArray[np.float64] = TETRAHEDRON) -> str:
    facets = "".join(
        "facet normal 0 0 0\n outer loop\n"
        + "".join(f"  vertex {x:g} {y:g} {z:e}\n" for x, y, z in one)
        + " endloop\nendfacet\n"
        for one in triangles.tolist()
    )
    return f"solid test\n{facets}endsolid test\n"


def dae(
    *,
    asset: str = '<unit meter="1"/>',
    effect: str = "",
    images: str = "",
    node: str = "",
    primitive: str | None = None,
    scene: str | None = None,
) -> str:
    """A COLLADA document with one geometry: the unit square with texture coordinates, at z = 0."""
    triangles = (
        '<triangles material="paint" count="2"><input semantic="VERTEX" source="#v" offset="0"/>'
        '<input semantic="TEXCOORD" source="#uv" offset="1"/>'
        "<p>0 0 1 1 2 2 0 0 2 2 3 3</p></triangles>"
    )
    instance = (
        f'<node id="n">{node}<instance_geometry url="#g"><bind_material><technique_common>'
        '<instance_material symbol="paint" target="#m"/>'
        "</technique_common></bind_material></instance_geometry></node>"
    )
    shown = f'<visual_scene id="s">{instance if scene is None else scene}</visual_scene>'
    return f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>{asset}</asset>
<library_images>{images}</library_images>
<library_effects><effect id="e"><profile_COMMON>{effect}</profile_COMMON></effect></library_effects>
<library_materials><material id="m"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
<technique_common><accessor count="4" stride="3"/></technique_common></source>
<source id="t"><float_array count="8">0 0 1 0 1 1 0 1</float_array>
<technique_common><accessor count="4" stride="2"/></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
{(primitive or triangles).replace("#uv", "#t")}
</mesh></geometry></library_geometries>
<library_visual_scenes>{shown}</library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def diffuse(inner: str, *, also: str = "") -> str:
    """The effect of a Lambert material."""
    return f'<technique sid="c"><lambert><diffuse>{inner}</diffuse>{also}</lambert></technique>'


def texture_effect(image: str = "i") -> str:
    """An effect that draws an image through surface and sampler, as exporters write it."""
    return (
        f'<newparam sid="f"><surface type="2D"><init_from>{image}</init_from></surface></newparam>'
        '<newparam sid="q"><sampler2D><source>f</source></sampler2D></newparam>'
    ) + diffuse('<texture texture="q" texcoord="UV"/>')


def gltf(document: dict[str, Any] | None = None, **changes: object) -> dict[str, Any]:
    """A glTF document of one red triangle; `changes` replace top-level entries."""
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 6},
        ],
        "buffers": [{"byteLength": 44}],
        **(document or {}),
        **changes,
    }


GLTF_BINARY = (
    np.array([0, 0, 0, 1, 0, 0, 0, 1, 0], "<f4").tobytes()
    + np.array([0, 1, 2], "<u2").tobytes()
    + b"\0\0"
)


def glb(document: dict[str, Any], binary: bytes = GLTF_BINARY) -> bytes:
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    body = struct.pack("<II", len(text), 0x4E4F534A) + text
    body += struct.pack("<II", len(binary), 0x004E4942) + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def glb_document(data: bytes) -> dict[str, Any]:
    """The JSON of a GLB."""
    (length,) = struct.unpack_from("<I", data, 12)
    return json.loads(data[20 : 20 + length])


def png(size: tuple[int, int] = (2, 2), told: tuple[int, int] | None = None) -> bytes:
    """An orange PNG; `told` is what its header says when that is a lie."""
    width, height = told or size
    rows = b"".join(b"\0" + b"\xff\x80\x00" * size[0] for _ in range(size[1]))
    return (
        b"\x89PNG\r\n\x1a\n"
        + _chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
        + _chunk(b"IDAT", zlib.compress(rows))
        + _chunk(b"IEND", b"")
    )


def _chunk(kind: bytes, data: bytes) -> bytes:
    checksum = struct.pack(">I", zlib.crc32(kind + data))
    return struct.pack(">I", len(data)) + kind + data + checksum


def bmp(size: tuple[int, int] = (2, 2)) -> bytes:
    """An image that browsers need as PNG."""
    from PIL import Image

    stream = io.BytesIO()
    Image.new("RGB", size, (255, 128, 0)).save(stream, "BMP")
    return stream.getvalue()


def size_m(mesh: LoadedMesh) -> list[float]:
    """Edges of the bounding box."""
    least, greatest = np.array(mesh.bounds_m)
    return (greatest - least).tolist()


def corners(mesh: LoadedMesh) -> set[tuple[float, ...]]:
    """Distinct points of the mesh."""
    return {tuple(point) for point in np.round(mesh.vertices, 6).tolist()}


def area_m2(vertices: NDArray[np.float32], faces: NDArray[np.uint32]) -> float:
    a, b, c = np.moveaxis(vertices.astype(np.float64)[faces], 1, 0)
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2)


def sentences(mesh: LoadedMesh) -> Sequence[str]:
    return [problem.sentence for problem in mesh.problems]
