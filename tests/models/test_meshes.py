from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.support import model_meshes, solids

if TYPE_CHECKING:
    from pathlib import Path

SOLIDS = {name: make() for name, make in model_meshes.STL.items()} | {
    f"{name} {part.name}": part.solid
    for painted in (model_meshes.DAE, model_meshes.GLB)
    for name, make in painted.items()
    for part in make()
}


def test_the_committed_meshes_are_what_their_script_writes(tmp_path: Path, models: Path):
    written = model_meshes.write_all(tmp_path)
    assert written
    for path in written:
        committed = models / path.relative_to(tmp_path)
        assert committed.read_bytes() == path.read_bytes(), f"{committed} is stale"


def test_no_mesh_is_without_a_script(models: Path):
    made = {models / name for name in (*model_meshes.STL, *model_meshes.DAE, *model_meshes.GLB)}
    assert {path for path in models.glob("*/meshes/*") if path.is_file()} == made


@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_encloses_room_with_its_corners_counter_clockwise(name: str):
    solid = SOLIDS[name]
    volume = np.einsum("ni,ni->n", solid[:, 0], np.cross(solid[:, 1], solid[:, 2])).sum() / 6
    assert volume > 0
    edges: dict[tuple[tuple[float, ...], tuple[float, ...]], int] = {}
    for triangle in (np.round(solid, 6) + 0.0).tolist():
        corners = [tuple(corner) for corner in triangle]
        for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
            edges[start, end] = edges.get((start, end), 0) + 1
    open_edges = [edge for edge in edges if edge[::-1] not in edges]
    assert not open_edges


def test_each_format_reads_back_as_the_same_triangles(tmp_path: Path):
    import trimesh

    part = solids.Painted("drum", solids.turned([(1.0, -0.5), (1.0, 0.5)], 12), (0.2, 0.4, 0.6))
    solids.write_stl(tmp_path / "a.stl", part.solid)
    solids.write_dae(tmp_path / "a.dae", [part])
    solids.write_glb(tmp_path / "a.glb", [part])
    for suffix in ("stl", "dae", "glb"):
        mesh = trimesh.load_mesh(tmp_path / f"a.{suffix}")  # pyright: ignore
        assert len(mesh.faces) == len(part.solid)  # pyright: ignore
        assert np.allclose(mesh.bounds, [[-1, -1, -0.5], [1, 1, 0.5]], atol=1e-4)  # pyright: ignore
