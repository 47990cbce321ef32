from __future__ import annotations

import base64
import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from studio.errors import MeshError
from tests.support.meshes import (
    GLTF_BINARY,
    area_m2,
    corners,
    glb,
    glb_document,
    gltf,
    png,
    read,
    sentences,
)

if TYPE_CHECKING:
    from pathlib import Path

POINTS = {(0, 0, 0), (1, 0, 0), (0, 1, 0)}
TEXTURED: dict[str, Any] = {
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    "textures": [{"source": 0}],
    "images": [{"uri": "paint.png"}],
    "meshes": [
        {
            "primitives": [
                {"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0}
            ]
        }
    ],
    "accessors": [
        *gltf()["accessors"],
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"},
    ],
}


def test_a_glb_is_its_triangle_in_its_colour(tmp_path: Path):
    mesh = read(tmp_path / "a.glb", glb(gltf()))
    assert corners(mesh) == POINTS
    (material,) = glb_document(mesh.glb)["materials"]
    assert material["pbrMetallicRoughness"]["baseColorFactor"] == pytest.approx([1, 0, 0, 1])


def test_a_glb_is_written_anew(tmp_path: Path):
    mine = glb(gltf(extras={"script": "<script>"}, images=[{"uri": "http://example.org/x.png"}]))
    mesh = read(tmp_path / "a.glb", mine)
    assert b"<script" not in mesh.glb
    assert b"http" not in mesh.glb


def test_a_gltf_reads_its_buffer_beside_it(tmp_path: Path):
    (tmp_path / "a b.bin").write_bytes(GLTF_BINARY)
    document = gltf(buffers=[{"uri": "a%20b.bin", "byteLength": 44}])
    assert corners(read(tmp_path / "a.gltf", json.dumps(document))) == POINTS


def test_a_gltf_may_hold_its_buffer(tmp_path: Path):
    uri = "data:application/octet-stream;base64," + base64.b64encode(GLTF_BINARY).decode()
    document = gltf(buffers=[{"uri": uri, "byteLength": 44}])
    assert corners(read(tmp_path / "a.gltf", json.dumps(document))) == POINTS


def test_nodes_are_placed_in_their_parents(tmp_path: Path):
    nodes = [
        {"children": [1], "translation": [0, 0, 5]},
        {"mesh": 0, "scale": [2, 2, 2], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476]},
    ]
    mesh = read(tmp_path / "a.glb", glb(gltf(nodes=nodes)))
    assert corners(mesh) == {(0, 0, 5), (0, 2, 5), (-2, 0, 5)}


def test_a_matrix_is_written_by_columns(tmp_path: Path):
    matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1]
    mesh = read(tmp_path / "a.glb", glb(gltf(nodes=[{"mesh": 0, "matrix": matrix}])))
    assert (7, 8, 9) in corners(mesh)


@pytest.mark.parametrize("mode", [5, 6])
def test_strips_and_fans_are_triangles(tmp_path: Path, mode: int):
    square = np.array([0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0], "<f4").reshape(4, 3)
    binary = (square if mode == 5 else square[[0, 1, 3, 2]]).tobytes()
    document = gltf(
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "mode": mode}]}],
        accessors=[{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}],
        bufferViews=[{"buffer": 0, "byteLength": 48}],
    )
    mesh = read(tmp_path / "a.glb", glb(document, binary))
    assert area_m2(mesh.vertices, mesh.faces) == pytest.approx(1)
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces], 1, 0)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_quantised_positions_are_numbers_again(tmp_path: Path):
    binary = np.array([0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0], "<i1").tobytes()
    document = gltf(
        extensionsRequired=["KHR_mesh_quantization"],
        meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}],
        accessors=[
            {"bufferView": 0, "componentType": 5120, "count": 3, "type": "VEC3", "normalized": True}
        ],
        bufferViews=[{"buffer": 0, "byteLength": 12, "byteStride": 4}],
    )
    assert corners(read(tmp_path / "a.glb", glb(document, binary))) == POINTS


def test_sparse_values_take_the_place_of_the_others(tmp_path: Path):
    binary = GLTF_BINARY + np.array([1], "<u4").tobytes() + np.array([9, 0, 0], "<f4").tobytes()
    position = {
        **gltf()["accessors"][0],
        "sparse": {
            "count": 1,
            "indices": {"bufferView": 2, "componentType": 5125},
            "values": {"bufferView": 3},
        },
    }
    document = gltf(
        accessors=[position, gltf()["accessors"][1]],
        bufferViews=[
            *gltf()["bufferViews"],
            {"buffer": 0, "byteOffset": 44, "byteLength": 4},
            {"buffer": 0, "byteOffset": 48, "byteLength": 12},
        ],
    )
    assert corners(read(tmp_path / "a.glb", glb(document, binary))) == {
        (0, 0, 0),
        (9, 0, 0),
        (0, 1, 0),
    }


def test_vertex_colours_are_kept(tmp_path: Path):
    binary = GLTF_BINARY + np.array([1, 0, 0, 0, 1, 0, 0, 0, 1], "<f4").tobytes()
    document = gltf(
        meshes=[{"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 2}, "indices": 1}]}],
        accessors=[
            *gltf()["accessors"],
            {"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3"},
        ],
        bufferViews=[*gltf()["bufferViews"], {"buffer": 0, "byteOffset": 44, "byteLength": 36}],
    )
    mesh = read(tmp_path / "a.glb", glb(document, binary))
    written = glb_document(mesh.glb)
    assert "COLOR_0" in written["meshes"][0]["primitives"][0]["attributes"]
    assert written["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] == [1, 1, 1, 1]


def test_without_a_material_the_urdf_gives_the_colour(tmp_path: Path):
    document = gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}])
    assert read(tmp_path / "a.glb", glb(document)).glb == b""


def test_a_texture_is_taken_in(tmp_path: Path):
    (tmp_path / "paint.png").write_bytes(png())
    mesh = read(tmp_path / "a.glb", glb(gltf(TEXTURED)))
    assert png() in mesh.glb
    assert not mesh.problems


def test_a_missing_texture_is_said(tmp_path: Path):
    mesh = read(tmp_path / "a.glb", glb(gltf(TEXTURED)))
    assert "paint.png" in sentences(mesh)[0]


@pytest.mark.parametrize(
    "changes",
    [
        {"extensionsRequired": ["KHR_draco_mesh_compression"]},
        {"extensionsUsed": ["KHR_draco_mesh_compression"]},
        {
            "meshes": [
                {
                    "primitives": [
                        {
                            "attributes": {"POSITION": 0},
                            "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0}},
                        }
                    ]
                }
            ]
        },
    ],
)
def test_draco_is_refused_however_it_is_told(tmp_path: Path, changes: dict[str, Any]):
    with pytest.raises(MeshError, match="compressed with Draco"):
        read(tmp_path / "a.glb", glb(gltf(changes)))


def accessor(**changes: object) -> dict[str, Any]:
    return {"accessors": [{**gltf()["accessors"][0], **changes}, gltf()["accessors"][1]]}


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"extensionsRequired": ["ACME_secret"]}, "it needs ACME_secret"),
        ({"extensionsRequired": ["EXT_meshopt_compression"]}, "compressed with meshopt"),
        ({"asset": {"version": "1.0"}}, 'glTF "1.0"'),
        ({"nodes": "x"}, "its JSON is not that of a glTF"),
        ({"nodes": [{"children": [0]}]}, "without end"),
        ({"nodes": [{"mesh": 5}]}, "mesh 5, which it does not have"),
        ({"scenes": [{"nodes": [7]}]}, "node 7, which it does not have"),
        ({"nodes": [{"mesh": 0, "matrix": [1, 2]}]}, "not placed by finite numbers"),
        ({"nodes": []}, "node 0, which it does not have"),
        ({"bufferViews": []}, "buffer view 0, which it does not have"),
        ({"materials": []}, "material 0"),
        (accessor(count=4_000_000_000), "reach beyond their buffer"),
        (accessor(bufferView=None, count=4_000_000_000), "promises more values than it holds"),
        (accessor(byteOffset=-4), "reach beyond their buffer"),
        (accessor(type="VEC2"), "rows of 2 numbers"),
        (accessor(componentType=7), "no known type"),
        (accessor(count=2), "point beyond their vertices"),
        ({"buffers": [{"uri": "../a.bin", "byteLength": 44}]}, "outside the opened folders"),
        ({"buffers": [{"uri": "https://example.org/a", "byteLength": 44}]}, "over the network"),
        ({"buffers": [{"uri": "data:;base64,@@", "byteLength": 44}]}, "no base64"),
        ({"buffers": [{"uri": "missing.bin", "byteLength": 44}]}, "does not exist"),
    ],
)
def test_each_broken_document_says_what_is_wrong(
    tmp_path: Path, changes: dict[str, Any], said: str
):
    with pytest.raises(MeshError) as raised:
        read(tmp_path / "a.glb", glb(gltf(changes)))
    assert said in str(raised.value)


@pytest.mark.parametrize("data", [b"", b"glTF", glb(gltf())[:-20], b"{}", b"\xff\xfe{", b"[]"])
def test_what_is_no_gltf_is_said(tmp_path: Path, data: bytes):
    with pytest.raises(MeshError):
        read(tmp_path / "a.glb", data)


def test_a_mesh_shown_too_often_is_refused_before_it_is_built(tmp_path: Path):
    triangles = 1 << 16
    binary = GLTF_BINARY[:36] + np.zeros(3 * triangles, "<u2").tobytes()
    document = gltf(
        scenes=[{"nodes": list(range(100))}],
        nodes=[{"mesh": 0}] * 100,
        accessors=[
            gltf()["accessors"][0],
            {"bufferView": 1, "componentType": 5123, "count": 3 * triangles, "type": "SCALAR"},
        ],
        bufferViews=[
            gltf()["bufferViews"][0],
            {"buffer": 0, "byteOffset": 36, "byteLength": 6 * triangles},
        ],
    )
    with pytest.raises(MeshError, match="more than 4,000,000 triangles"):
        read(tmp_path / "a.glb", glb(document, binary))
