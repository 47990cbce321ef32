from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.errors import MeshError
from tests.support.meshes import TETRAHEDRON, corners, read, sentences, size_m, stl, stl_text

if TYPE_CHECKING:
    from pathlib import Path

POINTS = {(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)}


def test_a_binary_stl_is_its_triangles_and_has_no_colour(tmp_path: Path):
    mesh = read(tmp_path / "a.stl", stl())
    assert corners(mesh) == POINTS
    assert len(mesh.faces) == 4
    assert mesh.glb == b""
    assert mesh.bounds_m == ((0, 0, 0), (1, 1, 1))


def test_a_text_stl_is_the_same_mesh(tmp_path: Path):
    mesh = read(tmp_path / "A.STL", stl_text())
    assert corners(mesh) == POINTS
    assert len(mesh.faces) == 4


def test_a_binary_stl_may_begin_with_solid(tmp_path: Path):
    assert len(read(tmp_path / "a.stl", b"solid" + stl()[5:]).faces) == 4


def test_bytes_behind_the_triangles_do_not_matter(tmp_path: Path):
    assert len(read(tmp_path / "a.stl", stl() + b"tail").faces) == 4


def test_a_header_that_promises_billions_is_refused_at_once(tmp_path: Path):
    with pytest.raises(MeshError, match="promises 4294967295 triangles"):
        read(tmp_path / "a.stl", stl(told=0xFFFFFFFF))


@pytest.mark.parametrize("data", [b"", b"solid", b"\0" * 83, b"<html>" * 99, stl()[:-1]])
def test_what_is_no_stl_is_said(tmp_path: Path, data: bytes):
    with pytest.raises(MeshError):
        read(tmp_path / "a.stl", data)


def test_a_text_stl_with_a_word_for_a_number_is_said(tmp_path: Path):
    with pytest.raises(MeshError, match="not three numbers"):
        read(tmp_path / "a.stl", stl_text().replace("vertex 0", "vertex zero", 1))


def test_a_text_stl_that_is_cut_off_is_said(tmp_path: Path):
    text = stl_text()
    with pytest.raises(MeshError, match="cut off"):
        read(tmp_path / "a.stl", text[: text.rindex("vertex")])


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e30])
def test_impossible_corners_are_left_out_and_said(tmp_path: Path, bad: float):
    triangles = TETRAHEDRON.copy()
    triangles[0, 0, 0] = bad
    mesh = read(tmp_path / "a.stl", stl(triangles))
    assert len(mesh.faces) == 3
    assert np.isfinite(mesh.vertices).all()
    assert "1 triangles with impossible coordinates" in sentences(mesh)[0]


def test_a_mesh_of_nothing_but_nan_is_an_error(tmp_path: Path):
    with pytest.raises(MeshError, match="no triangle that can be drawn"):
        read(tmp_path / "a.stl", stl(np.full((2, 3, 3), np.nan)))


def test_an_empty_stl_is_an_error(tmp_path: Path):
    with pytest.raises(MeshError, match="no triangle"):
        read(tmp_path / "a.stl", stl(np.zeros((0, 3, 3))))


def test_size_is_as_written(tmp_path: Path):
    assert size_m(read(tmp_path / "a.stl", stl(TETRAHEDRON * 2))) == [2, 2, 2]
