from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.problems import Fix, MacroCall, Place
from studio.robot.checks.finding import AddChild, RemoveChild, SetAttributes
from studio.robot.checks.mending import Mender
from studio.robot.checks.robot_checks import check_robot
from tests.support.checked import (
    FILE,
    applied,
    box,
    checked,
    codes,
    inertial,
    joint,
    link,
    mended,
    problem_of,
    robot,
)

CALLED = (MacroCall("wheel", Place(FILE, 9, 1)),)
LAID_OUT = """\
<robot name="r">
  <link name="base"/>
  <link name="arm">
    <inertial>
      <mass value="0"/>
    </inertial>
  </link>
  <joint name="arm" type="revolute">
    <parent link="base"/>
    <child link="arm"/>
    <!-- how far? -->
  </joint>
</robot>
"""


def fix_of(mend: AddChild | RemoveChild | SetAttributes, text: str, key: str) -> Fix | None:
    one = checked(text)
    part = one.part(key)
    assert part is not None
    return Mender(one.source).fix(mend, part)


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_an_added_element_stands_on_a_line_of_its_own_like_the_others(newline: str):
    after = mended(LAID_OUT.replace("\n", newline), "missing-limit")
    lines = after.split(newline)
    assert lines[10].strip() == "<!-- how far? -->"
    assert lines[11].startswith("    <limit lower=")
    assert lines[12] == "  </joint>"
    assert "missing-limit" not in codes(after)


@pytest.mark.parametrize("newline", ["\n", "\r\n"])
def test_a_removed_element_takes_its_lines_along(newline: str):
    after = mended(LAID_OUT.replace("\n", newline), "bad-mass")
    lines = after.split(newline)
    assert lines[2:4] == ['  <link name="arm">', "  </link>"]


def test_an_element_in_one_line_is_mended_in_that_line():
    one = robot(link("a"), link("b"), joint("revolute", "b", parent="a")).replace("\n", "")
    after = mended(one, "missing-limit")
    assert '<child link="b"/><limit ' in after
    assert "\n" not in after


def test_other_writings_and_a_byte_order_mark_stay_as_they_are():
    text = "\ufeff" + LAID_OUT.replace("how far?", "wie weit? größer als 😀")
    after = mended(text, "missing-limit")
    assert "größer als 😀" in after
    assert "missing-limit" not in codes(after)


def test_what_is_worked_out_is_not_written_over():
    swap = '<limit lower="${a}" upper="0" effort="1" velocity="1"/>'
    text = LAID_OUT.replace("<!-- how far? -->", swap)
    mend = SetAttributes("", ("limit",), (("lower", "1"),))
    assert fix_of(mend, text.replace("${a}", "3"), "joint:arm") is not None
    assert fix_of(mend, text, "joint:arm") is None
    assert fix_of(RemoveChild("", "limit"), text, "joint:arm") is None


def test_of_several_children_none_is_taken_for_the_one():
    twice = LAID_OUT.replace("<inertial>", "<inertial/><inertial>")
    assert fix_of(RemoveChild("", "inertial"), twice, "link:arm") is None
    assert fix_of(RemoveChild("", "visual"), LAID_OUT, "link:arm") is None


def test_an_element_that_closes_itself_is_not_opened():
    assert fix_of(AddChild("", "<limit/>"), LAID_OUT, "link:base") is None


def test_a_fix_for_one_part_does_not_touch_the_macro_of_many():
    urdf = (
        '<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="-1" ixy="0" '
        'ixz="0" iyy="1" iyz="0" izz="1"/></inertial><visual><geometry><box size="1 1 1"/>'
        "</geometry></visual></link></robot>"
    )
    assert problem_of(checked(urdf), "bad-inertia").fix is not None
    from_macro = problem_of(checked(urdf, calls=CALLED), "bad-inertia")
    assert from_macro.fix is None
    assert from_macro.macro_stack == CALLED


def test_a_text_that_has_moved_on_is_not_mended_where_the_part_was():
    one = checked(LAID_OUT)
    part = one.part("joint:arm")
    assert part is not None
    mend = AddChild("", "<limit/>")
    assert Mender(lambda _: b"\n" + LAID_OUT.encode()).fix(mend, part) is None
    assert Mender(lambda _: b"<robot").fix(mend, part) is None
    assert Mender(lambda _: None).fix(mend, part) is None


def test_the_edits_of_a_fix_hold_what_they_replace():
    fix = problem_of(checked(LAID_OUT), "bad-mass").fix
    assert fix is not None
    assert fix.action == "edit"
    assert all(edit.before for edit in fix.edits)
    assert "<inertial>" not in applied(LAID_OUT, fix)


NUMBERS = st.sampled_from(["-1", "0", "1", "2.50", "1e-9", "1e6"])
ATTRIBUTES = st.lists(
    st.tuples(st.sampled_from(["lower", "upper", "effort", "velocity"]), NUMBERS),
    unique_by=lambda one: one[0],
)
KINDS = st.sampled_from(["revolute", "prismatic", "continous", "fixed", "ball", "Planar"])


def limit_of(attributes: list[tuple[str, str]] | None) -> str:
    if attributes is None:
        return ""
    return "<limit" + "".join(f' {name}="{text}"' for name, text in attributes) + "/>"


def joint_of(kind: str, attributes: list[tuple[str, str]] | None, axis: str) -> str:
    return joint(kind, "arm", f'<axis xyz="{axis} 0 0"/>{limit_of(attributes)}')


def link_of(mass_kg: str, moments: tuple[str, str, str], size: str) -> str:
    return link("arm", inertial(mass_kg, *moments), box("collision", size) if size else "")


JOINTS = st.builds(joint_of, KINDS, st.none() | ATTRIBUTES, NUMBERS)
SIZES = st.sampled_from(["", "0.1 0.2 0.3", "1 0 0", "0.001 0.001 0.001", "0 0 0"])
LINKS = st.builds(link_of, NUMBERS, st.tuples(NUMBERS, NUMBERS, NUMBERS), SIZES)


@settings(deadline=None)  # of a loaded machine
@given(JOINTS, LINKS)
def test_click_after_click_comes_to_an_end_with_nothing_left_to_click(one: str, arm: str):
    text = robot(link("base"), arm, one)
    for _ in range(12):
        fix = next((found.fix for found in check_robot(checked(text)) if found.fix), None)
        if fix is None:
            return
        text = applied(text, fix)
    raise AssertionError(f"there is still something to click: {text}")
