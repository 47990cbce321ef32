"""Another name for a thing, wherever the run or the text says that it is named; or a refusal."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.editing.editor_text import EditorText
from studio.description.language.questions import Renaming, RenamingQuery
from studio.description.language.questions import SubjectKind as Kind
from studio.description.values import Edit, EditRequest, Expansion, NoReply
from tests.support.descriptions import robot, write
from tests.support.language import Editor, at, pr2, text_at
from tests.support.questioned_robot import FILES

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.requests import Reply


@pytest.fixture
def editor(tmp_path: Path) -> Editor:
    return Editor(tmp_path, write(tmp_path, FILES))


def asked(editor: Editor, file: Path, words: str, name: str) -> Reply:
    query = RenamingQuery(str(file), editor.text(file), editor.offset(file, words), name)
    return editor.ask(query)


def renaming(editor: Editor, file: Path, words: str, name: str) -> Renaming:
    reply = asked(editor, file, words, name)
    assert isinstance(reply, Renaming), reply
    return reply


def refusal(editor: Editor, words: str, name: str, file: Path | None = None) -> str:
    reply = asked(editor, file or editor.entry, words, name)
    assert isinstance(reply, NoReply), reply
    return reply.sentence


def places(found: Renaming) -> list[str]:
    return [f"{at(one.place)}{'' if one.in_run else '?'}" for one in found.places]


def one_file(tmp_path: Path, inside: str) -> Editor:
    return Editor(tmp_path, write(tmp_path, {"r.xacro": robot(inside)}))


def test_a_property_is_renamed_where_it_is_read_and_not_what_shadows_it(editor: Editor):
    found = renaming(editor, editor.entry, '"0 ${len|gth} 0"', "span")
    assert (found.kind, found.old, found.new) == (Kind.PROPERTY, "length", "span")
    assert places(found) == ["robot.xacro:5", "robot.xacro:12"]
    assert {text_at(one.place) for one in found.places} == {"length"}


def test_a_reader_that_the_run_did_not_come_by_is_renamed_and_told_apart(editor: Editor):
    found = renaming(editor, editor.root / "urdf/arm.xacro", '"${length} ${rea|ch}', "grasp")
    assert places(found) == ["arm.xacro:4", "arm.xacro:6", "robot.xacro:4", "robot.xacro:17?"]


def test_a_parameter_is_renamed_in_its_macro_and_in_calls(editor: Editor):
    found = renaming(editor, editor.root / "urdf/arm.xacro", 'params="side len|gth', "long")
    assert found.kind is Kind.PARAMETER
    assert places(found) == ["arm.xacro:4", "arm.xacro:6", "robot.xacro:13"]


def test_a_macro_is_renamed_in_opening_and_closing_tags(editor: Editor):
    found = renaming(editor, editor.root / "urdf/arm.xacro", '<xacro:macro name="a|rm"', "limb")
    assert places(found) == ["arm.xacro:4", *["robot.xacro:12"] * 2, *["robot.xacro:13"] * 2]
    assert {text_at(one.place) for one in found.places} == {"arm"}


@pytest.mark.parametrize(
    ("words", "kind", "lines"),
    [
        ("$(arg ki|nd)", Kind.ARG, ["robot.xacro:2", "robot.xacro:14"]),
        ("sizes.ma|ss", Kind.PROPERTY, ["robot.xacro:10", "sizes.xacro:1"]),
        ("conf|ig[", Kind.PROPERTY, ["robot.xacro:8", "robot.xacro:10"]),
    ],
)
def test_args_and_names_behind_a_namespace_are_renamed(
    editor: Editor, words: str, kind: Kind, lines: list[str]
):
    found = renaming(editor, editor.entry, words, "another")
    assert (found.kind, places(found)) == (kind, lines)


def test_a_block_is_renamed_where_it_is_inserted(editor: Editor):
    found = renaming(editor, editor.root / "urdf/arm.xacro", "*ori|gin", "pose")
    assert (found.kind, places(found)) == (Kind.BLOCK, ["arm.xacro:4", "arm.xacro:9"])


def test_all_definitions_of_one_scope_go_together_also_the_branch_not_taken(tmp_path: Path):
    editor = one_file(
        tmp_path,
        """<xacro:arg name="big" default="true"/>
<xacro:if value="$(arg big)"><xacro:property name="size" value="2"/></xacro:if>
<xacro:unless value="$(arg big)"><xacro:property name="size" value="1"/></xacro:unless>
<link name="l${size}"/>""",
    )
    found = renaming(editor, editor.entry, '"l${si|ze}"', "width")
    assert [one.place.line for one in found.places] == [2, 3, 4]


def test_arg_by_its_name_in_a_call_is_renamed(tmp_path: Path):
    editor = one_file(
        tmp_path,
        """<xacro:arg name="side" default="left"/>
<link name="${xacro.arg('side')}_$(eval side)"/>""",
    )
    found = renaming(editor, editor.entry, '<xacro:arg name="si|de"', "hand")
    assert [one.place.line for one in found.places] == [1, 2, 2]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("", "is no name"),
        ("a b", "is no name"),
        ("2nd", "is no name"),
        ("x" * 201, "is no name"),
        ("a${b}", "is no name"),
        ("length", "called length already"),
        ("lambda", "a word of the language"),
        ("pi", "knows pi already"),
        ("reach", "is a name already"),
    ],
)
def test_what_is_no_name_or_taken_is_refused(editor: Editor, name: str, words: str):
    assert words in refusal(editor, '"0 ${len|gth} 0"', name)


def test_a_parameter_may_not_take_a_name_that_its_macro_reads(editor: Editor):
    arm = editor.root / "urdf/arm.xacro"
    assert "reach is a name already" in refusal(editor, 'params="si|de', "reach", arm)


def test_what_has_no_name_of_its_own_is_refused(editor: Editor):
    assert "Only properties" in refusal(editor, "<gaze|bo", "x")
    assert "Only properties" in refusal(editor, 'name="ba|se"', "x")


@pytest.mark.parametrize(
    ("inside", "words", "reason"),
    [
        (
            """<xacro:property name="a_size" value="1"/><xacro:property name="which" value="a"/>
<xacro:property name="${which}_size" value="2"/><link name="l${a_size}"/>""",
            '"l${a_|size}"',
            "makes a name by an expression",
        ),
        (
            """<xacro:macro name="m" params="size:=^"><link name="l${size}"/></xacro:macro>
<xacro:property name="size" value="1"/><xacro:m/><link name="k${size}"/>""",
            '"k${si|ze}"',
            "by name (:=^)",
        ),
        (
            """<xacro:macro name="show"><link name="l${size}"/></xacro:macro>
<xacro:macro name="m" params="size"><xacro:show/></xacro:macro>
<xacro:property name="size" value="1"/><xacro:m size="2"/><xacro:property name="size" value="3"/>
<link name="k${size}"/><xacro:if value="0"><xacro:show/></xacro:if>""",
            '"k${si|ze}"',
            "",
        ),
        (
            """<xacro:macro name="m"><link name="l"/></xacro:macro>
<xacro:property name="which" value="m"/><xacro:call macro="${which}"/>""",
            '<xacro:macro name="|m"',
            "an expression",
        ),
        (
            """<xacro:arg name="side" default="a"/><xacro:property name="n" value="side"/>
<link name="${xacro.arg(n)}"/>""",
            '<xacro:arg name="si|de"',
            "makes the name of an arg",
        ),
    ],
)
def test_what_nobody_can_vouch_for_is_refused_or_leaves_the_robot_as_it_is(
    tmp_path: Path, inside: str, words: str, reason: str
):
    editor = one_file(tmp_path, inside)
    reply = asked(editor, editor.entry, words, "another")
    if reason:
        assert isinstance(reply, NoReply)
        assert reason in reply.sentence
    else:
        assert isinstance(reply, NoReply | Renaming)
        if isinstance(reply, Renaming):
            check_same_robot(editor, reply)


def test_while_the_texts_do_not_run_nothing_is_renamed(editor: Editor):
    data = editor.text(editor.entry)
    at_byte = data.index(b"</robot>")
    editor.type(editor.entry, at_byte, at_byte, b'<link name="${nothing}"/>')
    assert "do not run" in refusal(editor, '"0 ${len|gth} 0"', "span")


def check_same_robot(editor: Editor, found: Renaming) -> None:
    """Write the new name; the run must change nothing of the robot."""
    edits = [
        Edit(one.place.file, one.start, one.end, found.new.encode())
        for one in reversed(found.places)
    ]
    answer = editor.session.answer(EditRequest(tuple(edits)))
    assert isinstance(answer, Expansion), answer
    assert answer.part_order is None
    assert not [part for part in answer.changed_parts if found.new not in part.xml]


def test_odd_bytes_keep_their_places(tmp_path: Path):
    inside = '<!-- Größe 🤖 --><xacro:property name="size" value="1"/><link name="ü${size}"/>'
    data = b"\xef\xbb\xbf" + robot(inside).replace("\n", "\r\n").encode()
    editor = Editor(tmp_path, write(tmp_path, {"r.xacro": data}))
    found = renaming(editor, editor.entry, "ü${si|ze}", "width")
    assert [data[one.start : one.end] for one in found.places] == [b"size", b"size"]
    assert "width" not in EditorText(data).text
    check_same_robot(editor, found)


def test_every_property_of_a_real_robot_is_renamed_or_refused_and_the_robot_stays():
    editor = pr2()
    file = editor.root / "pr2_description/urdf/base_v0/base.urdf.xacro"
    data = editor.text(file)
    names = [word.split(b'"')[1].decode() for word in data.split(b"<xacro:property ")[1:6]]
    assert names
    for name in names:
        reply = asked(editor, file, f'<xacro:property name="{name[0]}|{name[1:]}"', f"{name}_new")
        assert isinstance(reply, Renaming), reply
        assert len(reply.places) >= 1
