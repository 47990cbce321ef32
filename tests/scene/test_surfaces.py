from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
import trimesh

from studio.displays.drawing import Triangles
from studio.scene.surfaces import glb_of, surface_of

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
FACE = np.array([[0, 1, 2]], np.uint32)
COLORS = np.array([[255, 0, 0], [0, 128, 0], [0, 0, 3]], np.uint8)


def test_a_foreign_reader_finds_the_same_triangles_and_colours_in_the_glb():
    scene: Any = trimesh.load(io.BytesIO(glb_of(CORNERS, FACE, COLORS)), file_type="glb")  # pyright: ignore[reportUnknownMemberType]
    (mesh,) = scene.geometry.values()
    np.testing.assert_array_equal(mesh.vertices, CORNERS)
    np.testing.assert_array_equal(mesh.faces, FACE)
    light = mesh.visual.vertex_attributes["color"] / 65535
    assert light[0].tolist() == [1, 0, 0, 1]
    assert light[1, 1] == pytest.approx(0.2158, abs=1e-3)  # what sRGB 128 is
    assert light[2, 2] == pytest.approx(3 / 255 / 12.92, abs=1e-5)


def test_a_triangle_without_all_its_corners_is_skipped():
    faces = np.array([[0, 1, 2], [0, 1, 3]], np.uint32)
    (drawn,) = surface_of(Triangles(CORNERS, faces, COLORS[0]), "1").values()
    assert drawn.flowing["faces"].tolist() == [[0, 1, 2]]
    assert surface_of(Triangles(CORNERS, faces[1:], COLORS[0]), "1") == {}
    lost = np.where(CORNERS == 1, np.nan, CORNERS).astype(np.float32)
    assert surface_of(Triangles(lost, faces[:1], COLORS), "1") == {}
    assert surface_of(Triangles(CORNERS[:0], faces[:0], COLORS[:0]), "1") == {}
