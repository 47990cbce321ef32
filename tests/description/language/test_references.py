"""Who names a thing: exactly where the run came by, by its name where it did not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.language.questions import SubjectKind as Kind
from tests.support.descriptions import robot, write
from tests.support.language import Editor, at, pr2, text_at
from tests.support.questioned_robot import FILES

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.language.questions import References


@pytest.fixture
def editor(tmp_path: Path) -> Editor:
    return Editor(tmp_path, write(tmp_path, FILES))


def named(found: References) -> list[str]:
    return [f"{at(one.place)} {text_at(one.place)}" for one in found.references]


def test_a_property_is_named_by_its_readers_and_not_by_what_shadows_it(editor: Editor):
    found = editor.references(editor.entry, '"0 ${len|gth} 0"')
    assert found.kind is Kind.PROPERTY
    assert named(found) == ["robot.xacro:5 length", "robot.xacro:12 length"]
    assert [one.is_definition for one in found.references] == [True, False]


def test_a_reader_that_the_run_did_not_come_by_is_told_apart(editor: Editor):
    found = editor.references(editor.root / "urdf/arm.xacro", '"${length} ${rea|ch}')
    assert named(found) == [
        "arm.xacro:4 reach",
        "arm.xacro:6 reach",
        "robot.xacro:4 reach",
        "robot.xacro:17 reach",
    ]
    assert [one.in_run for one in found.references] == [True, True, True, False]


def test_a_parameter_is_named_in_its_macro_and_by_calls(editor: Editor):
    found = editor.references(editor.root / "urdf/arm.xacro", 'params="si|de')
    assert named(found) == [
        "arm.xacro:4 side",
        "arm.xacro:5 side",
        "arm.xacro:8 side",
        "arm.xacro:9 side",
        "robot.xacro:12 side",
        "robot.xacro:13 side",
    ]


def test_a_block_is_named_where_it_is_inserted(editor: Editor):
    found = editor.references(editor.root / "urdf/arm.xacro", "*ori|gin")
    assert named(found) == ["arm.xacro:4 origin", "arm.xacro:9 origin"]


def test_calls_of_a_macro_are_found_from_its_definition(editor: Editor):
    found = editor.references(editor.root / "urdf/arm.xacro", 'macro name="a|rm"')
    assert named(found) == [
        "arm.xacro:4 arm",
        "robot.xacro:12 xacro:arm",
        "robot.xacro:13 xacro:arm",
    ]


def test_a_name_behind_a_namespace_is_found_without_it(editor: Editor):
    found = editor.references(editor.root / "urdf/sizes.xacro", 'name="ma|ss"')
    assert named(found) == ["robot.xacro:10 mass", "sizes.xacro:1 mass"]


def test_a_yaml_key_is_named_by_the_expressions_that_read_it(editor: Editor):
    found = editor.references(editor.root / "config/limits.yaml", "upper: 2|.5")
    assert named(found) == ["limits.yaml:4 2.5", "robot.xacro:10 upper"]
    assert editor.references(editor.root / "config/limits.yaml", "lower: -|1").count == 1


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("$(arg ki|nd)", ["robot.xacro:2 kind", "robot.xacro:14 kind"]),
        ("$(find rob|ot)", ["robot.xacro:6 robot"]),
        ('reference="left|_arm"', ["arm.xacro:5 ${side}_arm", "arm.xacro:9 ${side}_arm",
                                   "robot.xacro:16 left_arm"]),
        ("/urdf/ar|m.xacro", ["arm.xacro:1 ", "robot.xacro:6 $(find robot)/urdf/arm.xacro"]),
    ],
)  # fmt: skip
def test_args_packages_links_and_files_are_named(editor: Editor, words: str, expected: list[str]):
    assert named(editor.references(editor.entry, words)) == expected


def test_texts_between_tags_and_calls_that_are_not_made_name_things_too(tmp_path: Path):
    body = """
  <xacro:macro name="inner" params="topic size:=1"><link name="l${size}"/></xacro:macro>
  <xacro:macro name="never" params="topic"><!-- ${topic} <a> -->
    <xacro:inner topic="a"/><param name="p">x > 1 ${topic} </param>
  </xacro:macro>
  <xacro:property name="rate" value="5"/>
  <gazebo><rate a=">">${rate}</rate><![CDATA[ ${rate} ]]><update> ${rate * 2} </update></gazebo>
"""
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    inner = editor.references(editor.entry, 'name="inner" params="to|pic')
    assert named(inner) == ["a.xacro:2 topic", "a.xacro:4 topic"]
    assert [one.in_run for one in inner.references] == [True, False]
    never = editor.references(editor.entry, 'name="never" params="to|pic')
    assert named(never) == ["a.xacro:3 topic", "a.xacro:4 topic"]
    rate = editor.references(editor.entry, 'property name="ra|te"')
    assert named(rate) == ["a.xacro:6 rate", "a.xacro:7 rate", "a.xacro:7 rate"]
    assert all(one.in_run for one in rate.references)
    assert editor.meaning(editor.entry, "${ra|te}</rate>").values == ("5",)


def test_what_nothing_names_has_no_references(editor: Editor):
    found = editor.references(editor.entry, "<!-- [0.1:2] m h|ow")
    assert (found.kind, found.count) == (None, 0)


def test_properties_of_one_name_in_two_scopes_are_two(tmp_path: Path):
    body = """
  <xacro:property name="x" value="1"/>
  <xacro:macro name="m" params="">
    <xacro:property name="x" value="2"/><link name="a${x}"/>
  </xacro:macro>
  <xacro:m/>
  <link name="b${x}"/>
"""
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    assert named(editor.references(editor.entry, "b${|x}")) == ["a.xacro:2 x", "a.xacro:7 x"]
    inner = editor.references(editor.entry, "a${|x}")
    assert [one.place.line for one in inner.references] == [4, 4]


def test_pr2_every_place_that_reads_pi_says_so():
    editor = pr2()
    shoulder = editor.root / "pr2_description/urdf/shoulder_v0/shoulder.urdf.xacro"
    found = editor.references(shoulder, "${reflect*M_P|I/4")
    assert found.count > 30
    assert {text_at(one.place) for one in found.references} == {"M_PI"}
