"""What words stand for: by the run, across files, and in texts that no run has seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.language.questions import SubjectKind as Kind
from tests.support.corpus import corpus
from tests.support.descriptions import robot, write
from tests.support.language import Editor, at, pr2, text_at
from tests.support.questioned_robot import FILES

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def editor(tmp_path: Path) -> Editor:
    return Editor(tmp_path, write(tmp_path, FILES))


def arm(editor: Editor) -> Path:
    return editor.root / "urdf/arm.xacro"


def test_a_property_has_its_value_and_its_place(editor: Editor):
    found = editor.meaning(arm(editor), '"${length} ${rea|ch}')
    assert (found.kind, found.name, found.text, found.values) == (
        Kind.PROPERTY, "reach", "0.5", ("0.5",),
    )  # fmt: skip
    assert [text_at(place) for place in found.places] == ["reach"]
    assert at(found.places[0]) == "robot.xacro:4"


def test_a_parameter_shadows_a_property_of_its_name(editor: Editor):
    inside = editor.meaning(arm(editor), '"${len|gth} ${reach}')
    assert (inside.kind, inside.values) == (Kind.PARAMETER, ("1.0", "1"))
    assert inside.doc == "how far it reaches"
    assert [text_at(place) for place in inside.places] == ["length"]
    assert at(inside.places[0]) == "arm.xacro:4"
    outside = editor.meaning(editor.entry, '"0 ${len|gth} 0"')
    assert (outside.kind, outside.values) == (Kind.PROPERTY, ("7",))


def test_an_expression_has_a_value_for_each_call(editor: Editor):
    found = editor.meaning(arm(editor), 'link name="${si|de}_arm"')
    assert (found.kind, found.values) == (Kind.PARAMETER, ("left", "right"))
    assert found.doc == "left or right"
    whole = editor.meaning(editor.entry, "sizes.mass |* config")
    assert (whole.kind, whole.values) == (Kind.EXPRESSION, ("7.5",))


def test_a_default_is_looked_up_where_it_is_written(editor: Editor):
    found = editor.meaning(arm(editor), "length:=${rea|ch * 2}")
    assert (found.kind, found.values) == (Kind.PROPERTY, ("0.5",))
    assert found.expression_values == ("1.0",)


def test_a_call_leads_to_its_macro(editor: Editor):
    found = editor.meaning(editor.entry, '<xacro:a|rm side="left"')
    assert (found.kind, found.name, found.calls) == (Kind.MACRO, "arm", 2)
    assert [text_at(place) for place in found.places] == ["arm"]
    assert found.doc.startswith("One arm.")
    assert [(one.name, one.kind, one.default) for one in found.parameters] == [
        ("side", "value", None),
        ("length", "value", "${reach * 2}"),
        ("origin", "block", None),
    ]
    given = editor.meaning(editor.entry, '<xacro:arm si|de="left"')
    assert (given.kind, given.values, text_at(given.places[0])) == (
        Kind.PARAMETER, ("left",), "side",
    )  # fmt: skip


def test_a_block_leads_to_the_parameter_that_takes_it(editor: Editor):
    found = editor.meaning(arm(editor), 'insert_block name="ori|gin"')
    assert (found.kind, text_at(found.places[0])) == (Kind.BLOCK, "origin")


def test_a_name_in_a_namespace_leads_into_its_file(editor: Editor):
    space = editor.meaning(editor.entry, "${si|zes.mass")
    assert (space.kind, at(space.places[0]), text_at(space.places[0])) == (
        Kind.NAMESPACE, "robot.xacro:7", "sizes",
    )  # fmt: skip
    inside = editor.meaning(editor.entry, "sizes.ma|ss")
    assert (inside.kind, inside.values, at(inside.places[0])) == (
        Kind.PROPERTY, ("3",), "sizes.xacro:1",
    )  # fmt: skip


@pytest.mark.parametrize(
    "words", ["config['joints']['lift'].up|per", "config['joints']['lift'].|upper"]
)
def test_a_yaml_key_leads_to_its_value(editor: Editor, words: str):
    found = editor.meaning(editor.entry, words)
    assert (found.kind, found.name, found.values) == (Kind.YAML, "joints.lift.upper", ("2.5",))
    assert (at(found.places[0]), text_at(found.places[0])) == ("limits.yaml:4", "2.5")


def test_in_a_yaml_file_itself_a_line_is_its_value(editor: Editor):
    found = editor.meaning(editor.root / "config/limits.yaml", "upper: 2|.5")
    assert (found.kind, found.name, found.text) == (Kind.YAML, "joints.lift.upper", "2.5")


def test_files_and_packages_lead_to_where_they_are(editor: Editor):
    include = editor.meaning(editor.entry, "/urdf/ar|m.xacro")
    assert (include.kind, include.target) == (Kind.FILE, str(arm(editor)))
    package = editor.meaning(editor.entry, "$(find rob|ot)")
    assert (package.kind, package.target) == (Kind.PACKAGE, str(editor.root))
    yaml = editor.meaning(editor.entry, "limits|.yaml")
    assert (yaml.kind, yaml.target) == (Kind.FILE, str(editor.root / "config/limits.yaml"))


def test_a_file_named_by_an_expression_is_what_it_came_to(tmp_path: Path):
    files = {
        "a.xacro": robot(
            '<xacro:property name="part" value="arm"/><xacro:include filename="${part}.xacro"/>'
            '<xacro:include filename="more_*.xacro"/>'
            '<link name="l"><visual><geometry><mesh filename="meshes/${part}.stl"/></geometry>'
            "</visual></link>"
        ),
        "arm.xacro": robot(""),
        "more_1.xacro": robot(""),
        "more_2.xacro": robot(""),
        "meshes/arm.stl": b"",
    }
    editor = Editor(tmp_path, write(tmp_path, files))
    include = editor.meaning(editor.entry, "${part}.xa|cro")
    assert (include.kind, [at(place) for place in include.places]) == (Kind.FILE, ["arm.xacro:1"])
    several = editor.meaning(editor.entry, "more_|*")
    assert [at(place) for place in several.places] == ["more_1.xacro:1", "more_2.xacro:1"]
    mesh = editor.meaning(editor.entry, "${part}.s|tl")
    assert (mesh.target, mesh.places) == (str(tmp_path / "meshes/arm.stl"), ())


def test_an_arg_is_known_by_its_value(editor: Editor):
    found = editor.meaning(editor.entry, "$(arg ki|nd)")
    assert (found.kind, found.values, at(found.places[0])) == (
        Kind.ARG, ("long",), "robot.xacro:2",
    )  # fmt: skip
    given = Editor(editor.root, editor.entry, {"kind": "short"})
    assert given.meaning(given.entry, "$(arg ki|nd)").values == ("short",)


def test_links_lead_to_the_element_that_made_them(editor: Editor):
    found = editor.meaning(editor.entry, 'reference="left|_arm"')
    assert (found.kind, at(found.places[0])) == (Kind.LINK, "arm.xacro:5")


def test_functions_loops_and_words_of_xacro_are_known(editor: Editor):
    assert editor.meaning(editor.entry, "load_|yaml(").kind is Kind.FUNCTION
    assert editor.meaning(editor.entry, "[|n for n").kind is Kind.VARIABLE
    assert editor.meaning(editor.entry, "<xacro:inc|lude").name == "include"
    assert editor.maybe(editor.entry, "<!-- [0.1|:2]") is None


def test_what_the_run_did_not_come_by_is_told_by_its_name(editor: Editor):
    found = editor.meaning(editor.entry, '<link name="${rea|ch}"/>')
    assert (found.kind, [at(place) for place in found.places]) == (
        Kind.PROPERTY, ["robot.xacro:4"],
    )  # fmt: skip
    assert found.expression_values == ()


def test_a_text_that_no_run_has_seen_declares_its_own_names(tmp_path: Path):
    body = '<xacro:property name="new" value="1"/><link name="${new}"><broken'
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    found = editor.meaning(editor.entry, "${ne|w}")
    assert (found.kind, [text_at(place) for place in found.places]) == (Kind.PROPERTY, ["new"])
    assert (found.text, found.values) == ("1", ())
    macro = '<xacro:macro name="m" params="size"><link name="${size}"/><xacro:m'
    editor.texts[editor.entry] = robot(macro).encode()
    parameter = editor.meaning(editor.entry, "${si|ze}")
    assert (parameter.kind, parameter.places[0].length) == (Kind.PARAMETER, 4)


def test_after_typing_a_definition_is_where_it_moved_to(editor: Editor):
    assert at(editor.meaning(arm(editor), '"${length} ${rea|ch}').places[0]) == "robot.xacro:4"
    text = editor.entry.read_bytes()
    editor.texts[editor.entry] = text.replace(b"<xacro:arg", b"\n\n<broken <xacro:arg", 1)
    found = editor.meaning(editor.entry, '"0 ${len|gth} 0"')
    assert (at(found.places[0]), found.values) == ("robot.xacro:7", ("7",))


AWKWARD = (
    '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">\n'
    '  <!-- größe -->\n  <xacro:property name="größe" value="2"/>\n'
    '  <link name="🤖 ${größe + 1} ${größe}"/>\n</robot>\n'
)


@pytest.mark.parametrize("line_break", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_offsets_and_columns_are_those_of_the_editor_whatever_the_bytes(
    tmp_path: Path, line_break: str, encoding: str
):
    data = AWKWARD.replace("\n", line_break).encode(encoding)
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": data}))
    found = editor.meaning(editor.entry, "1} ${grö|ße}")
    assert (found.kind, found.values) == (Kind.PROPERTY, ("2",))
    line = AWKWARD.split("\n")[3]
    units = len(line[: line.rindex("größe")].encode("utf-16-le")) // 2
    start = len("\n".join(AWKWARD.split("\n")[:3]).encode("utf-16-le")) // 2 + 1 + units
    assert (found.start, found.end) == (start, start + 5)
    assert [(place.line, text_at(place)) for place in found.places] == [(3, "größe")]


def test_a_file_in_latin_1_is_read_as_it_declares(tmp_path: Path):
    text = '<?xml version="1.0" encoding="iso-8859-1"?>' + AWKWARD.replace("🤖", "ö")
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": text.encode("latin-1")}))
    assert text_at(editor.meaning(editor.entry, "1} ${grö|ße}").places[0]) == "größe"


def test_pr2_a_macro_of_another_file_and_the_values_of_its_calls():
    editor = pr2()
    macro = editor.meaning(editor.entry, "<xacro:pr2_shou|lder_v0")
    assert (macro.calls, at(macro.places[0])) == (2, "shoulder.urdf.xacro:17")
    shoulder = editor.root / "pr2_description/urdf/shoulder_v0/shoulder.urdf.xacro"
    side = editor.meaning(shoulder, 'name="${si|de}_shoulder_pan_joint"')
    assert side.values == ("r", "l")
    reflected = editor.meaning(shoulder, "${reflect*M_P|I/4")
    assert reflected.values == ("3.141592653589793",)
    assert len(reflected.expression_values) == 2


def test_ur10e_a_yaml_key_through_two_properties():
    root = corpus() / "UniversalRobots+Universal_Robots_ROS2_Description"
    arguments = {"ur_type": "ur10e", "name": "ur"}
    editor = Editor(root, root / "urdf/ur.urdf.xacro", arguments)
    common = root / "urdf/inc/ur_common.xacro"
    found = editor.meaning(common, "sec_limits['shoulder_pan_joint']['max_posi|tion']")
    assert found.name == "joint_limits.shoulder_pan_joint.max_position"
    assert found.places[0].file == str(root / "config/ur10e/joint_limits.yaml")
    assert text_at(found.places[0]) == "360.0"


def test_turtlebot4_a_macro_of_another_package():
    root = corpus()
    entry = root / "turtlebot+turtlebot4/turtlebot4_description/urdf/standard/turtlebot4.urdf.xacro"
    editor = Editor(root, entry)
    found = editor.meaning(entry, "${3*cm|2m}")
    assert (found.kind, found.values) == (Kind.PROPERTY, ("0.01",))
    assert "iRobotEducation+create3_sim" in found.places[0].file
