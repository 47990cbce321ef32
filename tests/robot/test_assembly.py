from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.values import Part
from studio.problems import Severity
from studio.robot.values import Box, Material
from tests.support.expanded import Assembled, assembled, element_of

if TYPE_CHECKING:
    from studio.robot.assembly import Change


def box(name: str, size: str = "1 1 1", material: str = "") -> str:
    return (
        f'<link name="{name}"><visual><geometry><box size="{size}"/></geometry>'
        f"{material}</visual></link>"
    )


def fixed(name: str, parent: str, child: str, inner: str = "", kind: str = "fixed") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{child}"/>{inner}</joint>'
    )


def robot(*elements: str) -> str:
    return f'<robot name="r">{"".join(elements)}</robot>'


RED = '<material name="red"><color rgba="1 0 0 1"/></material>'
USES_RED = '<material name="red"/>'
TWO = robot(box("a"), box("b"), fixed("ab", "a", "b"))


def codes(change: Change) -> list[str]:
    return [problem.code for problem in change.problems]


def test_the_first_robot_is_all_new():
    change = assembled(TWO)
    assert list(change.robot.links) == ["a", "b"]
    assert change.changed_links == {"a", "b"}
    assert change.changed_joints == {"ab"}
    assert change.structural
    assert not change.problems


def test_only_the_link_that_was_written_anew_changes():
    change = Assembled(TWO).change("link:b", box("b", "2 2 2"))
    assert change.changed_links == {"b"}
    assert not change.changed_joints
    assert not change.structural
    assert change.robot.links["b"].visuals[0].geometry == Box((2, 2, 2))


@pytest.mark.parametrize("shape", ["visual", "collision"])
def test_another_mesh_is_more_than_other_numbers(shape: str):
    def link(mesh: str, scale: str) -> str:
        geometry = f'<geometry><mesh filename="{mesh}" scale="{scale}"/></geometry>'
        return f'<link name="a"><{shape}>{geometry}</{shape}></link>'

    made = Assembled(robot(link("a.stl", "1 1 1")))
    assert made.change("link:a", link("a.stl", "2 2 2")).only_numbers
    assert not made.change("link:a", link("b.stl", "2 2 2")).only_numbers
    assert not made.change("link:a", box("a")).only_numbers


def test_a_moved_joint_changes_no_link():
    change = Assembled(TWO).change("joint:ab", fixed("ab", "a", "b", '<origin xyz="1 0 0"/>'))
    assert change.changed_joints == {"ab"}
    assert not change.changed_links
    assert not change.structural


def test_the_same_text_again_changes_nothing():
    change = Assembled(TWO).change("link:b", box("b"))
    assert not change.changed_links
    assert not change.structural


def test_a_new_joint_type_is_structural():
    change = Assembled(TWO).change("joint:ab", fixed("ab", "a", "b", kind="continuous"))
    assert change.structural


def test_a_link_that_went_is_structural():
    change = Assembled(TWO).rewrite(robot(box("a")))
    assert change.structural
    assert list(change.robot.links) == ["a"]
    assert not change.changed_links


def test_a_changed_material_changes_the_links_that_use_it():
    one = Assembled(robot(RED, box("a", material=USES_RED), box("b"), fixed("ab", "a", "b")))
    change = one.change("material:red", RED.replace("1 0 0", "0 1 0"))
    assert change.changed_links == {"a"}
    material = change.robot.links["a"].visuals[0].material
    assert material == Material("red", (0, 1, 0, 1))


def test_a_material_may_stand_behind_the_link_that_uses_it():
    change = assembled(robot(box("a", material=USES_RED), RED))
    assert change.robot.links["a"].visuals[0].material == Material("red", (1, 0, 0, 1))
    assert not change.problems


def test_a_material_written_in_a_visual_is_known_to_the_others():
    change = assembled(
        robot(box("a", material=RED), box("b", material=USES_RED), fixed("ab", "a", "b"))
    )
    assert change.robot.links["b"].visuals[0].material == Material("red", (1, 0, 0, 1))


def test_an_undefined_material_is_a_warning_at_the_link():
    change = assembled(robot(box("z"), box("a", material=USES_RED), fixed("j", "z", "a")))
    assert codes(change) == ["undefined-material"]
    assert change.problems[0].place is not None
    assert change.problems[0].place.line == 2
    assert change.robot.links["a"].visuals[0].material is None


def test_a_broken_element_keeps_its_last_good_value_and_is_an_error():
    change = Assembled(TWO).change("link:b", box("b", "1 1 1,"))
    assert change.robot.links["b"].visuals[0].geometry == Box((1, 1, 1))
    assert not change.changed_links
    assert [problem.severity for problem in change.problems] == [Severity.ERROR]
    assert change.problems[0].place is not None


def test_a_mended_element_has_no_problem_left():
    one = Assembled(TWO)
    one.change("link:b", box("b", "1 1 1,"))
    change = one.change("link:b", box("b", "1 1 3"))
    assert not change.problems
    assert change.changed_links == {"b"}


def test_a_broken_joint_at_the_start_leaves_the_links():
    change = assembled(robot(box("a"), '<joint name="ab" type="fixed"/>'))
    assert list(change.robot.links) == ["a"]
    assert codes(change) == ["bad-element"]


def test_the_second_of_a_name_is_left_out_and_said():
    change = assembled(robot(box("a"), box("a", "2 2 2")))
    assert codes(change) == ["duplicate-link"]
    assert change.robot.links["a"].visuals[0].geometry == Box((1, 1, 1))
    assert change.problems[0].place is not None
    assert change.problems[0].place.line == 2


def test_a_cycle_keeps_the_robot_before_it():
    one = Assembled(TWO)
    change = one.rewrite(robot(box("a"), box("b"), fixed("ab", "a", "b"), fixed("ba", "b", "a")))
    assert change.kept_last_good
    assert codes(change) == ["cycle"]
    assert list(change.robot.joints) == ["ab"]
    assert not change.structural


def test_what_changed_during_a_cycle_is_told_when_it_is_gone():
    one = Assembled(TWO)
    one.rewrite(robot(box("a", "3 3 3"), box("b"), fixed("ab", "a", "b"), fixed("ba", "b", "a")))
    change = one.rewrite(robot(box("a", "3 3 3"), box("b"), fixed("ab", "a", "b")))
    assert change.changed_links == {"a"}
    assert not change.kept_last_good


def test_no_link_at_all_keeps_the_robot_before_it():
    change = Assembled(TWO).rewrite(robot())
    assert change.kept_last_good
    assert codes(change) == ["no-links"]
    assert list(change.robot.links) == ["a", "b"]


def test_an_empty_first_file_is_an_empty_robot():
    change = assembled(robot())
    assert change.kept_last_good
    assert not change.robot.links


def turning(name: str, leader: str, x: str) -> str:
    follows = f'<mimic joint="{leader}" multiplier="{x}"/>' if leader else ""
    inner = f'<origin xyz="{x} 0 0"/><limit lower="-1" upper="1"/>{follows}'
    return fixed(name, "b", "c", inner, "revolute")


MANY = robot(box("a"), box("b"), box("c"), RED, fixed("ab", "a", "b"), turning("bc", "", "1"))
SIZES = st.sampled_from(["1 1 1", "2 1 1", "3 1 1", "1 2", "x"])


def link_edit(name: str, size: str, material: str) -> tuple[str, str]:
    return f"link:{name}", box(name, size, material)


def hold_edit(parent: str, kind: str, x: str) -> tuple[str, str]:
    return "joint:ab", fixed("ab", parent, "b", f'<origin xyz="{x} 0 0"/>', kind)


def turn_edit(leader: str, x: str) -> tuple[str, str]:
    return "joint:bc", turning("bc", leader, x)


LINKS = st.builds(
    link_edit,
    st.sampled_from("abc"),
    SIZES,
    st.sampled_from(["", USES_RED, '<material name="blue"/>', RED.replace("1 0 0", "0 1 0")]),
)
JOINTS = st.one_of(
    st.builds(
        hold_edit,
        st.sampled_from("abc"),
        st.sampled_from(["fixed", "continuous", "revolute", "turny"]),
        st.sampled_from(["0", "1", "2", "?"]),
    ),
    st.builds(
        turn_edit,
        st.sampled_from(["", "ab", "none", "bc"]),
        st.sampled_from(["1", "2", "3"]),
    ),
)
REDS = st.sampled_from([("material:red", RED), ("material:red", RED.replace("1 0 0", "0 0 1"))])


@given(st.lists(st.one_of(LINKS, JOINTS, REDS), max_size=8))
def test_values_put_in_place_come_to_what_a_look_at_everything_comes_to(
    edits: list[tuple[str, str]],
):
    quick, slow = Assembled(MANY), Assembled(MANY)
    everything = tuple(one.key for one in slow.parts)
    for key, xml in edits:
        place = next(one.place for one in slow.parts if one.key == key)
        found = quick.change(key, xml)
        assert found == slow.assembly.apply(everything, [Part(key, element_of(xml), place)])
