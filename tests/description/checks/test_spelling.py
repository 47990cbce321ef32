from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.checked_texts import checked, mended

if TYPE_CHECKING:
    from pathlib import Path

VISUAL = "<link name='a'><visual>"


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ("<lnik name='a'></lnik>", "<link name='a'></link>"),
        ("<Link name='a'/>", "<link name='a'/>"),
        ("<link name='a'><vizual/></link>", "<link name='a'><visual/></link>"),
        ("<link name='a'><collison/></link>", "<link name='a'><collision/></link>"),
        ("<link name='a'><visual><orgin/></visual></link>", f"{VISUAL}<origin/></visual></link>"),
        ("<link nane='a'/>", "<link name='a'/>"),
        (
            "<link name='a'><visual><origin xyz='0 0 1' rpz='0 0 0'/></visual></link>",
            "<link name='a'><visual><origin xyz='0 0 1' rpy='0 0 0'/></visual></link>",
        ),
        (
            "<link name='a'><vizual><orgin/></vizual></link>",
            "<link name='a'><visual><origin/></visual></link>",
        ),
    ],
)  # fmt: skip
def test_what_is_nearly_right_is_told_and_mended(tmp_path: Path, wrong: str, right: str):
    problems = checked(tmp_path, wrong)
    assert {one.code for one in problems} <= {"unknown-element", "unknown-attribute"}
    assert all("did you mean" in one.sentence for one in problems)
    assert mended(tmp_path, problems) == right


@pytest.mark.parametrize(
    "body",
    [
        "<link name='a' type='b'><sensor/></link>",
        "<gazebo reference='a'><vizual/><material>Gazebo/Blue</material></gazebo>",
        "<link name='a'/><transmission name='t'><jont name='b'/></transmission>",
        "<link name='a'/><ros2_control><joint name='x'><comand/></joint></ros2_control>",
        "<link name='a'><visual><geometry><capsule/></geometry></visual></link>",
    ],
)
def test_what_others_read_is_left_alone(tmp_path: Path, body: str):
    assert checked(tmp_path, body) == ()


def test_what_a_macro_writes_often_is_told_once(tmp_path: Path):
    body = (
        "<xacro:macro name='m' params='n'><link name='${n}'><vizual/></link>"
        "<joint name='j${n}'><parent link='x'/><child link='${n}'/></joint></xacro:macro>"
        "<link name='x'/><xacro:m n='a'/><xacro:m n='b'/>"
    )
    (problem,) = checked(tmp_path, body)
    assert [call.macro for call in problem.macro_stack] == ["m"]
    assert problem.parts == ("link:a",)
