from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from studio.scene.solids import unit_mesh

if TYPE_CHECKING:
    from studio.displays.drawing import SolidKind

VOLUMES_M3: dict[SolidKind, float] = {
    "box": 1.0,
    "sphere": np.pi / 6,
    "cylinder": np.pi / 4,
    "cone": np.pi / 12,
}


@pytest.mark.parametrize("kind", VOLUMES_M3)
def test_a_unit_mesh_fits_into_its_cube_and_touches_all_sides_of_it(kind: SolidKind):
    mesh = unit_mesh(kind)
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    z_low, z_high = (0.0, 1.0) if kind == "cone" else (-0.5, 0.5)
    np.testing.assert_allclose(low, (-0.5, -0.5, z_low), atol=1e-6)
    np.testing.assert_allclose(high, (0.5, 0.5, z_high), atol=1e-6)


@pytest.mark.parametrize("kind", VOLUMES_M3)
def test_a_unit_mesh_is_closed_and_faces_outwards(kind: SolidKind):
    mesh = unit_mesh(kind)
    a, b, c = np.moveaxis(mesh.vertices[mesh.faces].astype(np.float64), 1, 0)
    # The sum over all triangles is the volume when each is seen from outside against the clock.
    volume_m3 = float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6
    assert 0.94 * VOLUMES_M3[kind] < volume_m3 <= VOLUMES_M3[kind] * (1 + 1e-6)
    assert abs(np.cross(b - a, c - a).sum(axis=0)).max() < 1e-5  # no hole: its sides cancel


def test_a_unit_mesh_is_made_once_and_cannot_be_written_into():
    mesh = unit_mesh("box")
    assert unit_mesh("box") is mesh
    with pytest.raises(ValueError, match="read-only"):
        mesh.vertices[0, 0] = 1
