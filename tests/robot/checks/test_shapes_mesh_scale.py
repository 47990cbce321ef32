from __future__ import annotations

import pytest

from tests.support.checked import box, checked, codes, link, mended, problem_of, robot


def meshed(scale: str = "", uri: str = "m.stl") -> str:
    mesh = f'<geometry><mesh filename="{uri}"{scale}/></geometry>'
    rest = [link(f"l{n}", box("visual", f"0.1 0.1 {n}.01")) for n in range(3)]
    return robot(link("base", f"<visual>{mesh}</visual><collision>{mesh}</collision>"), *rest)


def sized(
    side_m: float,
) -> dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]]:
    return {"m.stl": ((0, 0, 0), (side_m, side_m / 2, side_m / 2))}


@pytest.mark.parametrize(
    ("side_m", "said", "scale"),
    [
        (120.0, "120 m long: it seems to be drawn in millimetres", "0.001 0.001 0.001"),
        (0.0002, "0.2 mm long: it seems to be drawn in metres", "1000 1000 1000"),
    ],
)
def test_a_mesh_in_the_wrong_unit_is_found_once_and_mended_wherever_the_link_has_it(
    side_m: float, said: str, scale: str
):
    one = meshed()
    assert codes(one, sized(side_m)).count("mesh-scale") == 1
    assert said in problem_of(checked(one, sized(side_m)), "mesh-scale").sentence
    after = mended(one, "mesh-scale", sized(side_m))
    assert after.count(f'scale="{scale}"') == 2
    assert "mesh-scale" not in codes(after, sized(side_m))


def test_a_scale_that_is_written_is_written_over():
    after = mended(meshed(' scale="1 -1 1"'), "mesh-scale", sized(100.0))
    assert after.count('scale="0.001 -0.001 0.001"') == 2


@pytest.mark.parametrize("side_m", [20.0, 3.0, 0.1, 0.0005])
def test_a_crane_an_arm_and_a_screw_are_left_alone(side_m: float):
    assert "mesh-scale" not in codes(meshed(), sized(side_m))


def test_a_mesh_that_dwarfs_small_parts_is_found():
    small = robot(
        link("base", '<visual><geometry><mesh filename="m.stl"/></geometry></visual>'),
        *(link(f"l{n}", box("visual", f"0.01 0.01 0.0{n}1")) for n in range(3)),
    )
    assert "mesh-scale" in codes(small, sized(2.5))
    assert "mesh-scale" not in codes(small, sized(1.9))


def test_a_shape_of_many_metres_is_found_too():
    assert "shape-scale" in codes(robot(link("base", box("visual", "30 0.1 0.1"))))
    assert "shape-scale" not in codes(robot(link("base", box("visual", "15 0.1 0.1"))))


def test_a_mesh_without_extent_is_no_question_of_scale():
    assert "mesh-scale" not in codes(meshed(), sized(0.0))


def markers(scale: str) -> str:
    """A link of ordinary size, and a mesh that is tiny."""
    ordinary = '<visual><geometry><mesh filename="arm.stl" scale="0.001 0.001 0.001"/></geometry>'
    tiny = f'<visual><geometry><mesh filename="m.stl" scale="{scale}"/></geometry></visual>'
    return robot(link("base", f"{ordinary}</visual>"), link("marker", tiny))


def test_a_tiny_mesh_among_ordinary_ones_in_the_same_unit_is_a_marker():
    sizes = {"arm.stl": ((0.0, 0.0, 0.0), (300.0, 80.0, 80.0)), **sized(0.4)}
    assert "mesh-scale" not in codes(markers("0.001 0.001 0.001"), sizes)
    assert "mesh-scale" in codes(
        markers("0.001 0.001 0.001"), {**sizes, "arm.stl": sized(1)["m.stl"]}
    )


def test_a_tiny_mesh_with_a_scale_of_its_own_is_found():
    sizes = {"arm.stl": ((0.0, 0.0, 0.0), (300.0, 80.0, 80.0)), **sized(0.3)}
    one = markers("1e-6 1e-6 1e-6")
    assert "mesh-scale" in codes(one, sizes)
