from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import pytest

from studio.errors import MeshError
from tests.support.meshes import corners, read

if TYPE_CHECKING:
    from pathlib import Path

COLOURED = "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
TEXT = """ply
format ascii 1.0
element vertex {vertices}
property float x
property float y
property float z
{colors}element face 1
property list uchar int vertex_indices
end_header
"""
POINTS = {(0, 0, 0), (1, 0, 0), (0, 1, 0)}


def header(vertices: int = 3, colors: str = "") -> str:
    return TEXT.format(vertices=vertices, colors=colors)


def test_a_text_ply_is_its_triangle(tmp_path: Path):
    mesh = read(tmp_path / "a.ply", header() + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
    assert corners(mesh) == POINTS
    assert mesh.glb == b""


@pytest.mark.parametrize(("name", "order"), [("little", "<"), ("big", ">")])
def test_binary_plys_are_read_in_both_byte_orders(tmp_path: Path, name: str, order: str):
    head = header().replace("ascii", f"binary_{name}_endian").encode()
    body = struct.pack(f"{order}9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack(
        f"{order}B3i", 3, 0, 1, 2
    )
    assert corners(read(tmp_path / "a.ply", head + body)) == POINTS


def test_vertex_colours_are_kept(tmp_path: Path):
    rows = "0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n"
    assert b"COLOR_0" in read(tmp_path / "a.ply", header(3, COLOURED) + rows).glb


@pytest.mark.parametrize(
    "text",
    [
        "",
        "ply\n",
        "hello",
        header(),
        header() + "0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n",
        header(4_000_000_000) + "0 0 0\n",
        header().replace("ascii", "binary_little_endian"),
    ],
)
def test_what_is_no_ply_is_said(tmp_path: Path, text: str):
    with pytest.raises(MeshError):
        read(tmp_path / "a.ply", text)
