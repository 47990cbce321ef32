"""The outline of a robot's files: includes, macros, names."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.language.questions import SubjectKind as Kind
from tests.support.descriptions import robot, write
from tests.support.language import Editor, at, pr2
from tests.support.questioned_robot import FILES

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.language.questions import Outline


@pytest.fixture
def editor(tmp_path: Path) -> Editor:
    return Editor(tmp_path, write(tmp_path, FILES))


def tree(outline: Outline) -> list[str]:
    """Each file as `name in includer at line`."""
    return [
        f"{one.file.rpartition('/')[2]} in {outline.files[one.inside].file.rpartition('/')[2]}"
        f" at {one.place.line if one.place else 0}"
        for one in outline.files[1:]
    ]


def test_every_file_stands_below_the_one_that_brings_it_in(editor: Editor):
    outline = editor.outline()
    assert outline.files[0].file == str(editor.entry)
    assert tree(outline) == [
        "arm.xacro in robot.xacro at 6",
        "sizes.xacro in robot.xacro at 7",
        "limits.yaml in robot.xacro at 8",
    ]
    assert [(one.namespace, one.is_yaml) for one in outline.files] == [
        ("", False), ("", False), ("sizes", False), ("", True),
    ]  # fmt: skip
    assert outline.is_current


def test_an_include_that_is_not_taken_is_not_listed_and_one_in_a_macro_is_once(tmp_path: Path):
    files = {
        "a.xacro": robot(
            '<xacro:if value="0"><xacro:include filename="no.xacro"/></xacro:if>'
            '<xacro:macro name="m" params="x"><xacro:include filename="b.xacro"/></xacro:macro>'
            '<xacro:m x="1"/><xacro:m x="2"/>'
            '<xacro:include filename="lost.xacro" optional="true"/>'
            '<xacro:include filename="part_*.xacro"/>'
        ),
        "b.xacro": robot('<xacro:include filename="c.xacro" ns="deep"/>'),
        "c.xacro": robot('<xacro:macro name="inner" params=""/>'),
        "no.xacro": robot(""),
        "part_1.xacro": robot(""),
        "part_2.xacro": robot(""),
    }
    outline = Editor(tmp_path, write(tmp_path, files)).outline()
    assert tree(outline) == [
        "b.xacro in a.xacro at 1",
        "c.xacro in b.xacro at 1",
        "part_1.xacro in a.xacro at 1",
        "part_2.xacro in a.xacro at 1",
    ]
    assert [(one.name, one.calls) for one in outline.macros] == [("m", 2), ("deep.inner", 0)]


def test_macros_tell_what_they_take_and_where_they_are_called(editor: Editor):
    (arm,) = editor.outline().macros
    assert (arm.name, arm.calls, at(arm.place)) == ("arm", 2, "arm.xacro:4")
    assert arm.doc == "One arm.\nside: left or right; length - how far it reaches"
    assert [at(place) for place in arm.called_at] == ["robot.xacro:12", "robot.xacro:13"]
    assert [(one.name, one.kind, one.default) for one in arm.parameters] == [
        ("side", "value", None), ("length", "value", "${reach * 2}"), ("origin", "block", None),
    ]  # fmt: skip


def test_names_tell_what_they_came_to(editor: Editor):
    values = {one.name: one for one in editor.outline().values}
    assert (values["reach"].kind, values["reach"].values, at(values["reach"].place)) == (
        Kind.PROPERTY, ("0.5",), "robot.xacro:4",
    )  # fmt: skip
    assert (values["kind"].kind, values["kind"].text) == (Kind.ARG, "long")
    assert values["mass"].values == ("3",)


def test_while_the_texts_are_broken_the_last_good_state_is_told(editor: Editor):
    whole = editor.outline()
    start = editor.entry.read_bytes().index(b"<link")
    editor.type(editor.entry, start, start, b"<broken ")
    broken = editor.outline()
    assert (broken.files, broken.is_current) == (whole.files, False)
    editor.type(editor.entry, start, start + 8, b"")
    assert editor.outline().is_current


def test_without_any_run_that_worked_there_is_nothing_to_tell(tmp_path: Path):
    outline = Editor(tmp_path, write(tmp_path, {"a.xacro": robot("<broken")})).outline()
    assert (outline.files, outline.macros, outline.is_current) == ((), (), False)


def test_pr2_has_its_44_files_and_every_macro_once():
    outline = pr2().outline()
    assert len({one.file for one in outline.files}) == 44
    assert len({one.place for one in outline.macros}) == len(outline.macros) == 60
