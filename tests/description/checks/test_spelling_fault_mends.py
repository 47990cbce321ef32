from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.checked_texts import checked, mended
from tests.support.descriptions import robot
from tests.support.packages import write_package

if TYPE_CHECKING:
    from pathlib import Path

PROPERTY = '<xacro:property name="radius" value="1"/>'
MACRO = '<xacro:macro name="wheel" params="name *block"><link name="${name}"/></xacro:macro>'


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        (f'{PROPERTY}<link name="${{2*radus + radus}}"/>', ("radus", "radius")),
        (
            f'{PROPERTY}<xacro:property name="d" value="${{2*radus}}"/><link name="${{d}}"/>',
            ("radus", "radius"),
        ),
        (f'{MACRO}<xacro:whel name="a"><b/></xacro:whel>', ("xacro:whel", "xacro:wheel")),
        (f'{MACRO}<xacro:wheel nane="a"><b/></xacro:wheel>', ("nane", "name")),
        ('<xacro:arg name="side" default="l"/><link name="$(arg sid)"/>', ("sid)", "side)")),
    ],
)
def test_one_click_writes_the_name_that_was_meant(
    tmp_path: Path, wrong: str, right: tuple[str, str]
):
    problems = checked(tmp_path, wrong)
    assert "did you mean" in problems[0].sentence
    assert mended(tmp_path, problems) == wrong.replace(*right)


def test_a_package_that_is_nearly_there_is_named_and_else_its_folder_is_asked_for(tmp_path: Path):
    write_package(tmp_path / "ball_description", files={"a.xacro": robot("")})
    body = '<xacro:include filename="$(find ball_descripton)/a.xacro"/><link name="a"/>'
    problems = checked(tmp_path, body)
    assert mended(tmp_path, problems) == body.replace("descripton", "description")
    (far,) = checked(tmp_path, body.replace("ball_descripton", "elsewhere"))
    assert far.fix is not None
    assert (far.fix.action, far.fix.target) == ("choose_package", "elsewhere")


@pytest.mark.parametrize(
    "body",
    [
        '<xacro:include filename="parst.xacro"/><link name="a"/>',
        "<xacro:include filename='./parst.xacro'/><link name='a'/>",
        '<xacro:include filename="${\'parst.xacro\'}"/><link name="a"/>',
    ],
)
def test_a_file_that_is_nearly_there_is_named(tmp_path: Path, body: str):
    problems = checked(tmp_path, body, parts=robot(""))
    assert 'did you mean "parts.xacro"?' in problems[0].sentence
    assert mended(tmp_path, problems) == body.replace("parst", "parts")


def test_a_file_that_is_nowhere_is_told_without_a_guess(tmp_path: Path):
    (problem,) = checked(tmp_path, '<xacro:include filename="nothing/like_it.xacro"/>')
    assert (problem.code, problem.fix) == ("file-unreadable", None)


def test_of_several_places_the_one_that_was_evaluated_is_mended_first(tmp_path: Path):
    body = (
        f'{PROPERTY}<xacro:property name="d" value="${{radus}}"/>'
        '<xacro:property name="e" value="${radus}"/><link name="${d + e}"/>'
    )
    first = mended(tmp_path, checked(tmp_path, body))
    assert first == body.replace("radus", "radius", 1)
    assert mended(tmp_path, checked(tmp_path, first)) == body.replace("radus", "radius")


def test_a_text_in_quotes_is_no_name(tmp_path: Path):
    body = f"{PROPERTY}<link name=\"${{'radus' + radus}}\"/>"
    problems = checked(tmp_path, body)
    assert mended(tmp_path, problems) == body.replace("+ radus", "+ radius")
