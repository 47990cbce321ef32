from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from studio.robot.comparison import Row, differences
from studio.robot.values import (
    Box,
    Collision,
    Cylinder,
    Inertial,
    Joint,
    JointType,
    Limit,
    Link,
    Material,
    Mesh,
    Mimic,
    Origin,
    Robot,
    Sphere,
    Visual,
)
from tests.support.robots import rover

if TYPE_CHECKING:
    from studio.robot.values import Geometry

RED, BLUE = Material("red", (1, 0, 0, 1)), Material("blue", (0, 0, 1, 1))
HINGE = Joint("hinge", JointType.REVOLUTE, "base", "arm", limit=Limit(-1, 1, 10, 2), axis=(0, 0, 1))


def link(name: str, geometry: Geometry | None = None, material: Material | None = None) -> Link:
    visuals = (Visual(Origin(), geometry, material),) if geometry else ()
    return Link(name, visuals)


def robot(*parts: Link | Joint) -> Robot:
    return Robot(
        "r",
        {one.name: one for one in parts if isinstance(one, Link)},
        {one.name: one for one in parts if isinstance(one, Joint)},
    )


def rows(one: Link | Joint, other: Link | Joint) -> list[Row]:
    """The differences of one part, in a robot that has nothing else but what it needs."""
    base = [link("base"), link("arm")] if isinstance(one, Joint) else []
    found = differences(robot(*base, one), robot(*base, other))
    kind = "joint" if isinstance(one, Joint) else "link"
    assert {each.part for each in found} <= {f"{kind}:{one.name}"}
    return [each.row for each in found]


def told_of(found: list[Row]) -> list[str]:
    return [row.what for row in found]


def test_a_robot_differs_in_nothing_from_itself_or_its_like():
    assert differences(rover(), rover()) == ()


def test_wheels_of_another_radius_differ_in_that():
    found = differences(rover(), rover(wheel_radius_m=0.12))
    wheels = {one.part for one in found if one.part.startswith("link")}
    assert wheels == {f"link:wheel_{n}" for n in range(4)}
    assert Row("visual.radius", 0.105, 0.12, "m", 1) in [one.row for one in found]
    assert {one.row.what for one in found} == {"visual.radius", "collision.radius", "origin.z"}


@given(st.floats(0.01, 1), st.floats(0.01, 1))
def test_the_other_way_round_the_values_change_places(one_m: float, other_m: float):
    one, other = rover(wheel_radius_m=one_m), rover(wheel_radius_m=other_m)
    there = [
        (d.part, replace(d.row, one=d.row.other, other=d.row.one)) for d in differences(one, other)
    ]
    assert there == [(d.part, d.row) for d in differences(other, one)]


def test_parts_that_came_or_went_are_one_row_each():
    bare, armed = robot(link("base")), robot(link("base"), link("arm"), HINGE)
    came = differences(bare, armed)
    assert [(one.part, one.row.one, one.row.other) for one in came] == [
        ("link:arm", None, "link"),
        ("joint:hinge", None, "revolute"),
    ]
    went = differences(armed, bare)
    assert [(one.part, one.row.one) for one in went] == [
        ("link:arm", "link"),
        ("joint:hinge", "revolute"),
    ]


def test_a_link_on_another_parent_is_told_by_its_joint_or_by_itself():
    base, mast, arm = link("base"), link("mast"), link("arm")
    hold = Joint("hold", JointType.FIXED, "base", "mast")
    one = robot(base, mast, arm, hold, HINGE)
    moved = differences(one, robot(base, mast, arm, hold, replace(HINGE, parent="mast")))
    assert [(d.part, d.row) for d in moved] == [("joint:hinge", Row("parent", "base", "mast"))]
    other = replace(HINGE, name="knee", parent="mast")
    renamed = differences(one, robot(base, mast, arm, hold, other))
    assert ("link:arm", Row("parent", "base", "mast")) in [(d.part, d.row) for d in renamed]


def test_a_joint_differs_in_each_of_its_numbers():
    other = replace(
        HINGE,
        origin=Origin((0, 0, 0.5)),
        axis=(0, 1, 0),
        limit=Limit(-2, 1, 20, 2),
        mimic=Mimic("knee", 2.0),
    )
    found = {row.what: row for row in rows(HINGE, other)}
    assert found.keys() == {
        *("origin.z", "axis.y", "axis.z", "limit.lower", "limit.effort", "mimic"),
    }
    assert found["limit.lower"] == Row("limit.lower", -1, -2, "rad")
    assert found["mimic"] == Row("mimic", None, "knee")


def test_a_slide_has_limits_in_metres():
    slide = replace(HINGE, type=JointType.PRISMATIC)
    longer = replace(slide, limit=Limit(-1, 3, 11, 2.5))
    assert [row.unit for row in rows(slide, longer)] == ["m", "N", "m/s"]


def test_limits_of_joints_of_another_type_are_not_compared():
    assert told_of(rows(HINGE, replace(HINGE, type=JointType.PRISMATIC))) == ["type"]


def test_only_where_an_axis_points_matters():
    assert rows(HINGE, replace(HINGE, axis=(0, 0, 3))) == []
    assert told_of(rows(HINGE, replace(HINGE, axis=(0, 0, -1)))) == ["axis.z"]
    fixed = replace(HINGE, type=JointType.FIXED)
    assert rows(fixed, replace(fixed, axis=(1, 0, 0))) == []


def test_shapes_differ_in_their_own_measures():
    assert rows(link("a", Box((1, 1, 1))), link("a", Box((1, 1, 2)))) == [
        Row("visual.size.z", 1, 2, "m", 1)
    ]
    assert told_of(rows(link("a", Cylinder(1, 1)), link("a", Cylinder(2, 3)))) == [
        "visual.radius",
        "visual.length",
    ]
    assert told_of(rows(link("a", Sphere(1)), link("a", Sphere(2)))) == ["visual.radius"]
    assert rows(link("a", Mesh("m.stl")), link("a", Mesh("n.stl", (1, 1, 2)))) == [
        Row("visual.mesh", "m.stl", "n.stl", "", 1),
        Row("visual.scale.z", 1.0, 2, "", 1),
    ]
    assert rows(link("a", Box((1, 1, 1))), link("a", Sphere(1))) == [
        Row("visual.shape", "box", "sphere", "", 1)
    ]


def test_colours_and_textures_differ():
    assert rows(link("a", Sphere(1), RED), link("a", Sphere(1), BLUE)) == [
        Row("visual.color", "1 0 0 1", "0 0 1 1", "", 1)
    ]
    painted = Material("p", None, "p.png")
    assert told_of(rows(link("a", Sphere(1)), link("a", Sphere(1), painted))) == ["visual.texture"]


def test_shapes_are_counted_and_those_that_only_one_has_are_named():
    one = Link("a", (), (Collision(Origin(), Sphere(1)),))
    more = Collision(Origin(), Box((1, 1, 1)))
    assert rows(one, Link("a", (), (*one.collisions, more))) == [
        Row("collision", None, "box", "", 2)
    ]


def test_masses_differ_with_their_centre_and_inertia():
    one = Inertial(Origin(), 1.0, 1e-9, 0, 0, 1e-9, 0, 1e-9)
    other = replace(one, mass_kg=2.0, ixx=3e-9, origin=Origin((0.1, 0, 0)))
    found = rows(Link("a", inertial=one), Link("a", inertial=other))
    assert told_of(found) == ["mass", "inertial.x", "ixx"]
    assert rows(Link("a", inertial=one), Link("a")) == [Row("mass", 1.0, None, "kg")]
