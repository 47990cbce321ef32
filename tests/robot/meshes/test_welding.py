from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from studio.robot.meshes.surfaces import Surface
from studio.robot.meshes.welding import crease_normals, weld, weld_rows

BOX_QUADS = [
    [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
    [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)],
    [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
    [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
    [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
    [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
]
BOX = np.array(
    [[q[i] for i in triangle] for q in BOX_QUADS for triangle in ((0, 1, 2), (0, 2, 3))],
    dtype=np.float32,
).reshape(-1, 3)


def ring(sides: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    """The side of a cylinder of radius and height 1, without lids."""
    angles = np.arange(sides + 1) * (2 * np.pi / sides)
    angles[-1] = 0.0
    low = np.stack([np.cos(angles), np.sin(angles), np.zeros(sides + 1)], axis=1)
    high = low + np.array([0, 0, 1])
    faces = [
        part
        for n in range(sides)
        for part in ((low[n], low[n + 1], high[n + 1]), (low[n], high[n + 1], high[n]))
    ]
    return np.array(faces, dtype=np.float32).reshape(-1, 3)


@given(arrays(np.float32, (30, 2), elements=st.sampled_from([0.0, -0.0, 1.0, 2.0, -1.5])))
def test_equal_rows_have_one_number_in_order_of_appearance(
    rows: np.ndarray[tuple[int, ...], np.dtype[np.float32]],
):
    first, number = weld_rows(rows)
    np.testing.assert_array_equal(rows[first][number], rows)
    assert len(np.unique(rows + 0.0, axis=0)) == len(first)
    assert (np.diff(first) > 0).all()


def test_no_rows_are_no_numbers():
    first, number = weld_rows(np.zeros((0, 3), dtype=np.float32))
    assert (len(first), len(number)) == (0, 0)


def test_a_box_keeps_its_edges_sharp():
    welded = weld(Surface(BOX))
    assert len(welded.vertices) == 24
    assert sorted(np.abs(welded.normals).sum(axis=1).tolist()) == [1] * 24


def test_a_cylinder_is_smooth_all_round():
    welded = weld(Surface(ring(24)))
    assert len(welded.vertices) == 48
    outwards = welded.vertices * [1, 1, 0]
    np.testing.assert_allclose(welded.normals, outwards, atol=0.05)  # faces weigh by area


def test_a_coarse_prism_is_not_smooth():
    assert len(weld(Surface(ring(6))).vertices) == 24


def test_a_face_that_is_turned_inside_out_smooths_nothing():
    flat = np.array(
        [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], dtype=np.float32
    )
    normals, _ = crease_normals(flat)
    assert normals[:, 2].tolist() == [1, 1, 1, -1, -1, -1]


def test_triangles_without_area_get_no_nan():
    point = np.zeros((3, 3), dtype=np.float32)
    welded = weld(Surface(np.concatenate((BOX, point))))
    assert np.isfinite(welded.normals).all()


def test_normals_of_the_file_are_kept():
    slanted = np.full_like(BOX, np.sqrt(1 / 3))
    welded = weld(Surface(BOX, slanted))
    assert len(welded.vertices) == 8
    np.testing.assert_array_equal(welded.normals, slanted[:8])


def test_broken_normals_of_the_file_are_made_anew():
    assert np.isfinite(weld(Surface(BOX, np.full_like(BOX, np.nan))).normals).all()


def test_corners_of_different_colour_stay_apart():
    colors = np.zeros((36, 4), dtype=np.uint8)
    colors[:18, 0] = 255
    colors[:, 3] = 255
    welded = weld(Surface(BOX, np.ones_like(BOX), colors=colors))
    assert welded.colors is not None
    pairs = {
        (*v, *c) for v, c in zip(welded.vertices.tolist(), welded.colors.tolist(), strict=True)
    }
    assert len(pairs) == len(welded.vertices)


def test_a_mesh_of_one_point_a_thousand_times_is_welded():
    fan = np.zeros((3000, 3), dtype=np.float32)
    angles = np.arange(1001) * (2 * np.pi / 1000)
    rim = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1).astype(np.float32)
    fan[1::3], fan[2::3] = rim[:-1], rim[1:]
    assert len(weld(Surface(fan)).vertices) <= 1003
