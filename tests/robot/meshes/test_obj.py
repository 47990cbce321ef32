from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import MeshError
from tests.support.meshes import area_m2, corners, glb_document, png, read, sentences

if TYPE_CHECKING:
    from pathlib import Path

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
POINTS = {(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)}
UV = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f 1 2 3 4\n",
        "f -4 -3 -2 -1\n",
        "f 1// 2// 3// 4//\n",
        "f 1 2 \\\n 3 4 # a square\r\n",
    ],
)
def test_every_way_to_write_a_square_covers_it_once(tmp_path: Path, faces: str):
    mesh = read(tmp_path / "a.obj", SQUARE + faces)
    assert corners(mesh) == POINTS
    assert area_m2(mesh.vertices, mesh.faces) == pytest.approx(1)
    assert mesh.glb == b""


def test_materials_give_colours_by_group(tmp_path: Path):
    (tmp_path / "a b.mtl").write_text("newmtl red\nKd 1 0 0\nnewmtl glass\nKd 0 0 1\nd 0.5\n")
    text = f"mtllib a b.mtl\n{SQUARE}usemtl red\nf 1 2 3\nusemtl glass\nf 1 3 4\n"
    materials = glb_document(read(tmp_path / "a.obj", text).glb)["materials"]
    factors = [one["pbrMetallicRoughness"]["baseColorFactor"] for one in materials]
    assert factors == [[1, 0, 0, 1], [0, 0, 1, 0.5]]
    assert materials[1]["alphaMode"] == "BLEND"


def test_a_texture_is_taken_in(tmp_path: Path):
    (tmp_path / "paint.png").write_bytes(png())
    (tmp_path / "a.mtl").write_text("newmtl m\nKd 0 0 0\nmap_Kd -s 1 1 1 paint.png\n")
    text = f"mtllib a.mtl\n{SQUARE}{UV}usemtl m\nf 1/1 2/2 3/3 4/4\n"
    mesh = read(tmp_path / "a.obj", text)
    assert png() in mesh.glb
    (material,) = glb_document(mesh.glb)["materials"]
    assert material["pbrMetallicRoughness"]["baseColorFactor"] == [1, 1, 1, 1]


def test_vertex_colours_behind_the_positions_are_kept(tmp_path: Path):
    text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nf 1 2 3\n"
    assert b"COLOR_0" in read(tmp_path / "a.obj", text).glb


def test_lines_of_different_length_are_read(tmp_path: Path):
    text = "v 0 0 0\nv 1 0 0 1\nv 1 1 0\nf 1 2 3\n"
    assert len(read(tmp_path / "a.obj", text).faces) == 1


def test_a_missing_material_library_costs_only_the_colour(tmp_path: Path):
    mesh = read(tmp_path / "a.obj", f"mtllib gone.mtl\n{SQUARE}usemtl red\nf 1 2 3\n")
    assert "gone.mtl" in sentences(mesh)[0]
    assert mesh.glb == b""


def test_a_library_outside_the_roots_is_not_read(tmp_path: Path):
    (tmp_path / "a.mtl").write_text("newmtl red\nKd 1 0 0\n")
    (tmp_path / "in").mkdir()
    mesh = read(tmp_path / "in" / "a.obj", f"mtllib ../a.mtl\n{SQUARE}usemtl red\nf 1 2 3\n")
    assert mesh.glb == b""


@pytest.mark.parametrize(
    "text",
    [
        "",
        "\0\1\2",
        SQUARE,
        f"{SQUARE}f 1 2 9\n",
        f"{SQUARE}f 1 2 -9\n",
        f"{SQUARE}f 0 1 2\n",
        f"{SQUARE}f a b c\n",
        "v 0 0 x\nv 1 0 0\nv 1 1 0\nf 1 2 3\n",
        f"{SQUARE}f 1 2\n",
    ],
)
def test_what_is_no_mesh_is_said(tmp_path: Path, text: str):
    with pytest.raises(MeshError):
        read(tmp_path / "a.obj", text)


def test_faces_that_nobody_can_draw_are_counted_before_they_are_read(tmp_path: Path):
    flood = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n" + b"f x\n" * 4_000_001
    with pytest.raises(MeshError, match="more than 4,000,000 triangles"):
        read(tmp_path / "flood.obj", flood)
