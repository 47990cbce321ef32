from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

import numpy as np
import pytest
from PIL import Image

from studio.errors import MeshError
from studio.robot.meshes.files import MeshFiles
from studio.robot.meshes.reading import read_textured
from studio.robot.meshes.textured import (
    mesh_uris,
    scale_of,
    split_textured,
    textured_uri,
    unit_shape,
)
from studio.robot.values import (
    Box,
    Collision,
    Cylinder,
    Link,
    Material,
    Mesh,
    Origin,
    Sphere,
    Visual,
)
from tests.support.open_documents import engine, opened
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

WOOD = Material("wood", texture_uri="package://p/wood.png")
SHAPES = {"box": 12, "cylinder": 48 * 4, "sphere": 48 * 24 * 2}


def write_image(path: Path) -> Path:
    pixels = np.array([[[200, 120, 60]], [[90, 40, 10]]], dtype=np.uint8)
    Image.fromarray(np.tile(pixels, (8, 16, 1))).save(path)
    return path


@pytest.mark.parametrize("shape", SHAPES)
def test_a_unit_shape_is_one_across_and_centred_with_its_outside_outside(shape: str):
    corners, uv = unit_shape(shape)
    assert len(corners) == len(uv) == 3 * SHAPES[shape]
    np.testing.assert_allclose(corners.min(axis=0), -0.5, atol=1e-6)
    np.testing.assert_allclose(corners.max(axis=0), 0.5, atol=1e-6)
    assert uv.min() >= 0
    assert uv.max() <= 1
    triangles = corners.reshape(-1, 3, 3)
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    assert (np.einsum("ij,ij->i", normals, triangles.mean(axis=1)) > -1e-6).all()


def test_the_uri_of_a_textured_primitive_names_its_shape_and_image():
    uri = textured_uri(Box((1, 2, 3)), WOOD)
    assert split_textured(uri) == ("box", "package://p/wood.png")
    assert split_textured("package://p/a.stl") == ("", "package://p/a.stl")
    assert textured_uri(Mesh("a.stl"), WOOD) == textured_uri(Sphere(1), None) == ""


def test_a_link_names_its_meshes_and_textured_primitives():
    link = Link(
        "l",
        (Visual(Origin(), Cylinder(1, 2), WOOD), Visual(Origin(), Mesh("a.stl"), WOOD)),
        (Collision(Origin(), Mesh("b.stl")),),
    )
    assert list(mesh_uris(link)) == ["textured-cylinder:package://p/wood.png", "a.stl", "b.stl"]
    assert "b.stl" not in mesh_uris(link, collisions=False)


def test_a_shape_is_scaled_to_its_size():
    assert scale_of(Cylinder(0.1, 0.5)) == (0.2, 0.2, 0.5)
    assert scale_of(Sphere(0.5)) == (1.0, 1.0, 1.0)


def test_an_image_on_a_box_is_a_glb_with_it_inside(tmp_path: Path):
    mesh = read_textured(MeshFiles(write_image(tmp_path / "wood.png")), "box")
    assert len(mesh.faces) == 12
    assert b"image/png" in mesh.glb


def test_what_is_no_image_is_said(tmp_path: Path):
    (tmp_path / "wood.png").write_bytes(b"not an image")
    with pytest.raises(MeshError, match=r"wood\.png"):
        read_textured(MeshFiles(tmp_path / "wood.png"), "box")


@pytest.mark.parametrize("there", [True, False])
def test_a_textured_box_is_drawn_with_its_image_or_in_its_colour_with_a_problem(
    tmp_path: Path, *, there: bool
):
    urdf = (
        '<robot name="r"><material name="wood"><color rgba="1 0 0 1"/>'
        '<texture filename="package://p/wood.png"/></material><link name="base"><visual>'
        '<geometry><box size="1 2 3"/></geometry><material name="wood"/></visual></link></robot>'
    )
    package = write_package(tmp_path / "p", files={"urdf/r.urdf": urdf})
    if there:
        write_image(package / "wood.png")

    async def run() -> None:
        async with engine(tmp_path / "data") as made:
            document, ear = await opened(made, package / "urdf" / "r.urdf")
            assert document.scene.missing_meshes() == set()
            problems = [one["sentence"] for one in ear.last("problems")["problems"]]
            assert len(problems) == (not there)
            assert all("wood.png" in one and one.startswith("Texture") for one in problems)

    asyncio.run(run())
