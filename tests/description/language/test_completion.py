"""What may be typed, by where the cursor is, the likeliest first."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import pytest

from studio.description.language.questions import SubjectKind as Kind
from tests.support.descriptions import robot, write
from tests.support.language import Editor, labels, offered, pr2
from tests.support.questioned_robot import FILES

if TYPE_CHECKING:
    from pathlib import Path

END = "</robot>"


@pytest.fixture
def editor(tmp_path: Path) -> Editor:
    meshes = {"meshes/arm.stl": b"", "meshes/arm.txt": b"", "meshes/parts/hand.dae": b""}
    return Editor(tmp_path, write(tmp_path, {**FILES, **meshes}))


def at_end(editor: Editor, typed: str) -> list[str]:
    return labels(editor.completions(editor.entry, END, typed))


def test_a_call_is_written_with_the_values_that_it_must_have(editor: Editor):
    found = editor.completions(editor.entry, END, "<xacro:ar")
    call = offered(found, "xacro:arm")
    assert call.insert == 'xacro:arm side=""></xacro:arm>'
    assert [call.insert[start:end] for start, end in call.stops] == ["", ""]
    assert call.stops[0][0] == call.insert.index('"') + 1
    assert call.doc.startswith("One arm.")
    assert labels(found)[0] == "xacro:arg"


def test_a_tag_that_goes_on_gets_a_new_name_only(editor: Editor):
    found = editor.completions(editor.entry, 'arm side="left"', "")
    assert offered(found, "xacro:arm").insert == "xacro:arm"


@pytest.mark.parametrize(
    ("typed", "first"),
    [
        ("<link name='x'><", ["collision", "inertial", "visual"]),
        ("<geometry><", ["box", "capsule", "cylinder", "mesh", "sphere"]),
        ("<link name='x'><visual></", ["visual", "link", "robot"]),
    ],
)
def test_the_elements_that_fit_come_first(editor: Editor, typed: str, first: list[str]):
    assert at_end(editor, typed)[: len(first)] == first


def test_attributes_that_are_not_yet_given_are_offered_the_needed_ones_first(editor: Editor):
    assert at_end(editor, "<xacro:arm ") == ["side", "length"]
    assert at_end(editor, '<xacro:arm side="left" ') == ["length"]
    assert at_end(editor, "<xacro:property value='' ")[0] == "name"
    assert at_end(editor, "<mimic ") == ["joint", "multiplier", "offset"]
    side = offered(editor.completions(editor.entry, END, "<xacro:arm "), "side")
    assert (side.kind, side.insert, side.stops, side.doc) == (
        Kind.PARAMETER, 'side=""', ((6, 6),), "left or right",
    )  # fmt: skip


def test_inside_a_macro_its_parameters_come_before_properties_and_functions(editor: Editor):
    arm = editor.root / "urdf/arm.xacro"
    found = editor.completions(arm, "<xacro:insert_block", '<link name="${')
    assert labels(found)[:2] == ["length", "side"]
    assert offered(found, "side").detail == "left"
    assert labels(found).index("reach") < labels(found).index("radians")
    assert offered(found, "radians").insert == "radians()"
    assert not any(label.startswith(("*", "__")) for label in labels(found))


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("<link name='${re", ["reach"]),
        ("<link name='${sizes.", ["mass"]),
        ("<link name='${config.", ["joints"]),
        ("<link name='${config[\"", ["joints"]),
        ('<link name=\'${config["joints"].li', ["lift"]),
        ("<link name='${math.radi", ["radians"]),
        ("<link name='$(ar", ["arg"]),
        ("<link name='$(arg ki", ["kind"]),
        ("<link name='$(find ", ["robot"]),
        ("<link name='$(env ", ["USER"]),
        ("<link name='$(eval ki", ["kind"]),
        ("<link name='$", ["${}", "$(arg )", "$(find )"]),
    ],
)
def test_names_that_can_be_read_are_offered_with_what_is_below_them(
    editor: Editor, typed: str, expected: list[str]
):
    assert at_end(editor, typed)[: len(expected)] == expected


def test_values_show_what_names_came_to(editor: Editor):
    found = editor.completions(editor.entry, END, "<link name='${")
    assert (offered(found, "reach").detail, offered(found, "sizes").kind) == ("0.5", Kind.NAMESPACE)


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("<xacro:include filename='", ["arm.xacro", "robot.xacro", "sizes.xacro"]),
        ("<xacro:include filename='../", ["config/", "meshes/", "urdf/"]),
        ("<xacro:include filename='$(find robot)/urdf/s", ["sizes.xacro"]),
        ("<mesh filename='package://", ["robot/"]),
        ("<mesh filename='package://robot/meshes/", ["arm.stl", "parts/"]),
        ("<mesh filename='package://robot/meshes/parts/", ["hand.dae"]),
        ("<mesh filename='file://$(find robot)/meshes/a", ["arm.stl"]),
    ],
)
def test_files_of_the_right_kind_and_folders_are_offered(
    editor: Editor, typed: str, expected: list[str]
):
    assert at_end(editor, typed)[: len(expected)] == expected


@pytest.mark.parametrize("folder", ["../../", "/", "/etc/", "$(find robot)/../", "~/"])
def test_no_folder_outside_the_roots_is_told_of(editor: Editor, folder: str):
    found = editor.completions(editor.entry, END, f"<xacro:include filename='{folder}")
    assert [one for one in found.items if one.kind in {Kind.FILE, Kind.FOLDER}] == []


@pytest.mark.parametrize(
    ("typed", "expected"),
    [
        ("<joint name='j' type='", ["revolute", "continuous", "prismatic", "fixed"]),
        ("<joint name='j' type='pr", ["prismatic"]),
        ("<child link='left", ["left_arm"]),
        ("<mimic joint='", ["left_shoulder", "right_shoulder"]),
        ("<xacro:property scope='", ["parent", "global"]),
        ("<xacro:call macro='", ["arm"]),
    ],
)
def test_words_and_parts_are_offered_where_they_may_stand(
    editor: Editor, typed: str, expected: list[str]
):
    assert at_end(editor, typed)[: len(expected)] == expected


def test_a_block_of_the_macro_around_is_offered(editor: Editor):
    arm = editor.root / "urdf/arm.xacro"
    found = editor.completions(arm, "<parent", "<xacro:insert_block name='")
    assert labels(found) == ["origin"]


@pytest.mark.parametrize("typed", ["<!-- <link name='${", "<?x", "<![CDATA[ <", "text "])
def test_nothing_is_offered_where_nothing_may_stand(editor: Editor, typed: str):
    assert at_end(editor, typed) == []


def test_names_of_a_text_that_never_ran_are_offered(tmp_path: Path):
    body = '<xacro:property name="fresh" value="1"/><xacro:macro name="new_one" params="a b:=1"/><x'
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    assert at_end(editor, "y='1'/><link name='${fre") == ["fresh", "frexp"]
    call = offered(editor.completions(editor.entry, END, "y='1'/><xacro:new"), "xacro:new_one")
    assert call.insert == 'xacro:new_one a=""/>'


def test_what_is_replaced_is_the_word_around_the_cursor(editor: Editor):
    found = editor.completions(editor.entry, "length} 0", "")
    text = editor.entry.read_text()
    assert text[found.start : found.end] == "length"
    wide = "<link name='🤖 ${re"
    moved = editor.completions(editor.entry, END, wide)
    assert moved.end - moved.start == 2
    assert moved.end == text.index(END) + len(wide) + 1


def test_no_more_is_sent_than_anybody_reads_and_it_is_said(tmp_path: Path):
    names = "".join(f'<xacro:property name="p{n}" value="{n}"/>' for n in range(500))
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(names + "<link name='l'/>")}))
    found = editor.completions(editor.entry, END, "<link name='${p")
    assert (len(found.items), found.is_whole) == (200, False)
    assert editor.completions(editor.entry, END, "<link name='${p49").is_whole


def test_pr2_is_answered_at_once():
    editor = pr2()
    shoulder = editor.root / "pr2_description/urdf/shoulder_v0/shoulder.urdf.xacro"
    editor.completions(shoulder, "</robot>", "<link name='${")
    took: list[float] = []
    for typed in ("<link name='${", "<xacro:", "<", "<xacro:include filename='$(find ", "</"):
        began = time.thread_time()
        assert editor.completions(shoulder, "</robot>", typed).items
        took.append(time.thread_time() - began)
    assert min(took) < 0.02, took
