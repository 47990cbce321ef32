"""What is told of a word beside its values: unit, documentation, how it is written."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.descriptions import robot, write
from tests.support.language import Editor
from tests.support.questioned_robot import FILES

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def editor(tmp_path: Path) -> Editor:
    return Editor(tmp_path, write(tmp_path, FILES))


def test_a_property_has_the_unit_and_help_of_its_comment(editor: Editor):
    found = editor.meaning(editor.entry, 'name="rea|ch" value')
    assert (found.unit, found.doc) == ("m", "how far it reaches")


def test_a_yaml_value_has_its_unit_and_comment(tmp_path: Path):
    files = {
        "a.xacro": robot(
            "<xacro:property name='c' value=\"${xacro.load_yaml('c.yaml')}\"/>"
            "<link name='${c.turn}'/>"
        ),
        "c.yaml": "turn: !degrees 90  # how far it turns\n",
    }
    editor = Editor(tmp_path, write(tmp_path, files))
    found = editor.meaning(editor.entry, "${c.tu|rn}")
    assert (found.text, found.unit, found.doc) == ("90", "deg", "how far it turns")
    assert found.values[0].startswith("1.5707")


def test_many_calls_are_told_by_their_first_values_only(tmp_path: Path):
    calls = "".join(f'<xacro:m n="{n}"/>' for n in range(40))
    body = f'<xacro:macro name="m" params="n"><link name="l${{n}}"/></xacro:macro>{calls}'
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    assert editor.meaning(editor.entry, "l${|n}").values == tuple(str(n) for n in range(16))
    assert editor.meaning(editor.entry, '<xacro:|m n="3"').calls == 40


def test_large_values_are_told_short(tmp_path: Path):
    body = """<xacro:property name="long" value="${'ab' * 5000}"/><link name="${long}"/>
      <xacro:property name="many" value="${list(range(1000))}"/><link name="${many[3]}"/>"""
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    for words in ('name="${lo|ng}"', "${ma|ny[3]}"):
        (value,) = editor.meaning(editor.entry, words).values
        assert len(value) <= 120


def test_licences_and_old_code_are_no_documentation(tmp_path: Path):
    body = """
  <!-- Copyright somebody -->
  <!-- <xacro:old/> -->
  <!-- =====  A wheel.  ===== -->
  <xacro:macro name="m" params=""/>
  <xacro:m/>"""
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    assert editor.meaning(editor.entry, "  <xacro:|m/>").doc == "A wheel."


def test_a_comment_behind_one_value_is_not_told_of_the_next(tmp_path: Path):
    body = """
  <xacro:property name="a" value="1"/> <!-- [0:2] m the first one -->
  <xacro:property name="b" value="2"/> <!-- [0:4] m -->
  <xacro:property name="c" value="3"/> <!-- of c -->
  <!-- above the macro -->
  <xacro:macro name="m" params=""/> <!-- behind it -->
  <xacro:macro name="n" params=""/>
  <xacro:m/><xacro:n/><link name="l${a + b + c}"/>"""
    editor = Editor(tmp_path, write(tmp_path, {"a.xacro": robot(body)}))
    told = [editor.meaning(editor.entry, f"{name}|").doc for name in ("l${a", "a + b", "b + c")]
    assert told == ["the first one", "", "of c"]
    assert editor.meaning(editor.entry, "<xacro:|m/>").doc == "above the macro"
    assert editor.meaning(editor.entry, "<xacro:|n/>").doc == ""
