# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false
from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import trimesh

from studio.robot.measures import Volume, geometry_volume, is_closed, mesh_volume, shapes_volume
from studio.robot.meshes.loaded_mesh import LoadedMesh
from studio.robot.values import Box, Collision, Cylinder, Geometry, Mesh, Origin, Sphere

if TYPE_CHECKING:
    from numpy.typing import NDArray

FAR_M = 50.0


def loaded(vertices: NDArray[Any], faces: NDArray[Any]) -> LoadedMesh:
    """As a worker would hand it over."""
    points = np.asarray(vertices, np.float32)
    (a, b, c), (d, e, f) = points.min(0).tolist(), points.max(0).tolist()
    return LoadedMesh("d", points, np.asarray(faces, np.uint32), b"", ((a, b, c), (d, e, f)))


def split(made: trimesh.Trimesh) -> LoadedMesh:
    """Each triangle with corners of its own, as an STL file has them."""
    corners = made.triangles.reshape(-1, 3)
    return loaded(corners, np.arange(len(corners)).reshape(-1, 3))


SOLIDS: dict[str, Any] = {
    "ball": trimesh.creation.icosphere(subdivisions=3, radius=0.3),
    "ring": trimesh.creation.torus(0.4, 0.1),
    "bar": trimesh.creation.box((0.2, 0.5, 2.0)),
    "two": trimesh.util.concatenate(
        [trimesh.creation.box((1, 1, 1)), trimesh.creation.icosphere(radius=0.2)]
    ),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_a_closed_mesh_has_the_volume_that_trimesh_finds(name: str):
    solid = SOLIDS[name]
    wanted = float(solid.volume)
    for mesh in (loaded(solid.vertices, solid.faces), split(solid)):
        found = mesh_volume(mesh)
        assert found.is_exact
        assert found.volume_m3 == pytest.approx(wanted, rel=1e-5)


def test_a_solid_that_is_inside_out_or_far_from_zero_has_the_same_volume():
    ball = SOLIDS["ball"]
    assert mesh_volume(loaded(ball.vertices, ball.faces[:, ::-1])).is_exact
    far = mesh_volume(loaded(ball.vertices + FAR_M, ball.faces))
    assert far.is_exact
    assert far.volume_m3 == pytest.approx(float(ball.volume), rel=1e-3)


def test_a_surface_with_a_hole_takes_at_most_the_room_of_its_box():
    bar = SOLIDS["bar"]
    found = mesh_volume(loaded(bar.vertices, bar.faces[1:]))
    assert not found.is_exact
    assert found.volume_m3 == pytest.approx(0.2)


def test_a_pipe_without_ends_is_not_closed_though_its_sides_balance():
    pipe = trimesh.creation.cylinder(radius=0.1, height=1)
    sides = pipe.faces[np.abs(pipe.face_normals[:, 2]) < 0.5]
    assert not is_closed(np.asarray(pipe.vertices, np.float32), np.asarray(sides, np.uint32))
    assert is_closed(np.asarray(pipe.vertices, np.float32), np.asarray(pipe.faces, np.uint32))


def test_a_face_turned_the_wrong_way_opens_a_mesh():
    bar = SOLIDS["bar"]
    faces = bar.faces.copy()
    faces[3] = faces[3][::-1]
    assert not mesh_volume(loaded(bar.vertices, faces)).is_exact


@pytest.mark.parametrize(
    ("geometry", "volume_m3"),
    [
        (Box((1, 2, 3)), 6),
        (Cylinder(0.5, 2), math.pi / 2),
        (Sphere(3), 36 * math.pi),
        (Mesh("known", (-1, 2, 0.5)), 7),
    ],
)
def test_a_shape_has_the_volume_of_the_formula(geometry: Geometry, volume_m3: float):
    found = geometry_volume(geometry, {"known": Volume(7, is_exact=True)}.get)
    assert found is not None
    assert found.volume_m3 == pytest.approx(volume_m3)
    assert found.is_exact


def test_what_overflows_and_what_is_not_known_has_no_volume():
    assert geometry_volume(Sphere(1e200), {}.get) is None
    assert geometry_volume(Mesh("unknown"), {}.get) is None


def test_shapes_add_up_and_one_unknown_makes_the_sum_unknown():
    known = {"open": Volume(2, is_exact=False)}.get
    box = Collision(Origin(), Box((1, 1, 1)))
    assert shapes_volume((box, box), known) == Volume(2, is_exact=True)
    assert shapes_volume((box, Collision(Origin(), Mesh("open"))), known) == Volume(
        3, is_exact=False
    )
    assert shapes_volume((box, Collision(Origin(), Mesh("unknown"))), known) is None
    assert shapes_volume((), known) is None
