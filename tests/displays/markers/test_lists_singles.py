import pytest

from studio.displays.drawing import MeshFile, Text
from studio.displays.markers.kinds import Kind
from tests.support.markers import HALF, QUARTER_ABOUT_Z, marker, shown

BOTH_ORDERS = pytest.mark.parametrize("little", [True, False], ids=["little", "big"])
MESH = "package://rover/meshes/wheel.dae"


@BOTH_ORDERS
def test_a_text_is_as_high_as_scale_z_and_faces_the_camera(little: bool):
    one = marker(Kind.TEXT, text="Grüße", wxyz=QUARTER_ABOUT_Z, rgba=(0.0, 1.0, 0.0, 0.2))
    assert shown(one, little=little) == {
        "text-0": Text("Grüße", (1.0, 2.0, 3.0), 2.0, (0, 255, 0), 51 / 255)
    }


@BOTH_ORDERS
def test_a_mesh_has_the_colour_of_its_marker(little: bool):
    one = marker(Kind.MESH, mesh_resource=MESH, wxyz=QUARTER_ABOUT_Z, scale=(1.0, -1.0, 2.0))
    [mesh] = shown(one, little=little).values()
    assert isinstance(mesh, MeshFile)
    assert (mesh.uri, mesh.scale, mesh.rgb) == (MESH, (1.0, -1.0, 2.0), (255, 0, 51))
    assert (mesh.position, mesh.opacity) == ((1.0, 2.0, 3.0), 1.0)
    assert mesh.wxyz == pytest.approx((HALF, 0.0, 0.0, HALF))


@pytest.mark.parametrize(
    ("rgba", "opacity"),
    [((0.0, 0.0, 0.0, 0.0), 1.0), ((1.0, 1.0, 1.0, 1.0), 1.0), ((1.0, 1.0, 1.0, 0.2), 51 / 255)],
)
def test_a_mesh_with_its_own_materials_keeps_them_and_takes_the_alpha(
    rgba: tuple[float, float, float, float], opacity: float
):
    one = marker(Kind.MESH, mesh_resource=MESH, mesh_use_embedded_materials=True, rgba=rgba)
    [mesh] = shown(one).values()
    assert isinstance(mesh, MeshFile)
    assert (mesh.rgb, mesh.opacity) == (None, opacity)


@pytest.mark.parametrize(
    "one",
    [
        marker(Kind.TEXT),
        marker(Kind.TEXT, text=" \n"),
        marker(Kind.TEXT, text="a", scale=(1.0, 1.0, 0.0)),
        marker(Kind.TEXT, text="a", rgba=(1.0, 1.0, 1.0, 0.0)),
        marker(Kind.MESH),
        marker(Kind.MESH, mesh_resource="https://example.org/m.dae"),
        marker(Kind.MESH, mesh_resource=MESH, rgba=(0.0, 0.0, 0.0, 0.0)),
        marker(Kind.MESH, mesh_resource=MESH, scale=(1.0, 0.0, 1.0)),
    ],
)
def test_texts_and_meshes_that_show_nothing_are_not_drawn(one: object):
    assert shown(one) == {}


def test_a_text_without_end_is_cut():
    [text] = shown(marker(Kind.TEXT, text="x" * 100_000)).values()
    assert isinstance(text, Text)
    assert len(text.text) == 2000


def test_each_text_and_mesh_of_a_namespace_is_a_shape_of_its_own():
    two = [marker(Kind.TEXT, number, text=f"t{number}") for number in range(2)]
    mesh = marker(Kind.MESH, 9, mesh_resource=MESH)
    assert list(shown(*two, mesh)) == ["text-0", "text-1", "mesh-2"]
