"""Texts found again by name: in edited files, in files changed elsewhere, never by byte."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.editing.edits import apply
from studio.description.editing.variants import NamedTexts, TextName, differing_names
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from pathlib import Path

XACRO = b"""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="arm" default="true"/>
  <xacro:property name="size" value="1"/>
  <xacro:macro name="body" params="name mass:=2.5">
    <xacro:property name="size" value="3"/>
    <link name="${name}">
      <visual><geometry><sphere radius="0.1"/></geometry></visual>
      <visual><geometry><sphere radius="0.2"/></geometry></visual>
    </link>
  </xacro:macro>
</robot>
"""
YAML = b"limits:\n  pan: {lower: -1, upper: 1}  # rad\n"


def name(kind: SiteKind, called: str, within: str = "", number: int = 1) -> TextName:
    return TextName("r.xacro", kind, called, within, number)


SIZE = name(SiteKind.PROPERTY, "size")
INNER = name(SiteKind.PROPERTY, "size", number=2)
MASS = name(SiteKind.PARAM_DEFAULT, "mass", "body")
ARM = name(SiteKind.ARG, "arm")


def texts(data: bytes = XACRO) -> NamedTexts:
    return NamedTexts("r.xacro", "/p/r.xacro", data)


@pytest.mark.parametrize(
    ("which", "before", "after"),
    [
        (SIZE, b'"size" value="1"', b'"size" value="7"'),
        (INNER, b'"size" value="3"', b'"size" value="7"'),
        (MASS, b"mass:=2.5", b"mass:=7"),
        (ARM, b'default="true"', b'default="7"'),
        (
            name(SiteKind.LITERAL, "link/visual[2]/geometry/sphere @radius", "${name}"),
            b'"0.2"',
            b'"7"',
        ),
    ],
)
def test_every_kind_of_text_is_told_by_name_and_written_again(
    which: TextName, before: bytes, after: bytes
):
    edited = XACRO.replace(before, after)
    assert texts().differing(edited) == {which: "7"}
    assert texts().with_texts({which: "7"}) == (edited, ())


def test_a_key_of_a_yaml_file_is_told_by_its_path():
    named = NamedTexts("limits.yaml", "/p/limits.yaml", YAML)
    upper = TextName("limits.yaml", SiteKind.YAML, "limits.pan.upper")
    edited = YAML.replace(b"upper: 1", b"upper: 1.5")
    assert named.differing(edited) == {upper: "1.5"}
    assert named.with_texts({upper: "1.5"}) == (edited, ())


def test_a_name_outlives_edits_elsewhere():
    moved = XACRO.replace(b"<robot ", b'<!-- new -->\n<robot version="1" ').replace(
        b'  <xacro:arg name="arm"',
        b'  <xacro:arg name="leg" default="0"/>\n  <xacro:arg name="arm"',
    )
    written, left_out = texts(moved).with_texts({MASS: "9", SIZE: "8"})
    assert left_out == ()
    assert written == moved.replace(b"mass:=2.5", b"mass:=9").replace(b'value="1"', b'value="8"')


def test_what_the_texts_do_not_name_goes_back_to_the_disk():
    now = XACRO.replace(b'value="1"', b'value="5"').replace(b"mass:=2.5", b"mass:=4")
    placed = texts().edits_to(now, {MASS: "9"})
    assert apply(now, placed.edits) == XACRO.replace(b"mass:=2.5", b"mass:=9")


def test_edits_that_are_no_value_stay():
    now = XACRO.replace(b"</robot>", b'  <link name="new"/>\n</robot>')
    placed = texts().edits_to(now, {SIZE: "8"})
    assert apply(now, placed.edits) == now.replace(b'value="1"', b'value="8"')


def test_a_text_that_is_gone_is_told_and_the_rest_is_written():
    gone = name(SiteKind.PROPERTY, "height")
    written, left_out = texts().with_texts({gone: "1", SIZE: "8"})
    assert written == XACRO.replace(b'value="1"', b'value="8"')
    assert left_out == ("r.xacro has no property height any more.",)


def test_a_text_that_its_place_cannot_hold_is_told():
    named = NamedTexts("limits.yaml", "/p/limits.yaml", YAML)
    upper = TextName("limits.yaml", SiteKind.YAML, "limits.pan.upper")
    written, (sentence,) = named.with_texts({upper: "\ud800"})
    assert written == YAML
    assert sentence.startswith("limits.yaml, key limits.pan.upper: ")


@pytest.mark.parametrize("now", [b"", b"<robot", b"\xff\xfe", b"<!DOCTYPE x><robot/>"])
def test_a_file_that_cannot_be_read_has_no_texts(now: bytes):
    assert texts().differing(now) == {}
    assert texts(now).with_texts({SIZE: "8"})[0] == now


def test_a_number_that_was_typed_over_with_an_expression_is_still_told():
    radius = name(SiteKind.LITERAL, "link/visual[1]/geometry/sphere @radius", "${name}")
    now = XACRO.replace(b'"0.1"', b'"${size / 10}"')
    assert texts().differing(now) == {radius: "${size / 10}"}
    assert apply(now, texts().edits_to(now, {}).edits) == XACRO


def test_names_that_differ_are_those_that_one_lacks_or_both_say_differently():
    one, other = {SIZE: "1", ARM: "true"}, {ARM: "true", MASS: "3"}
    assert set(differing_names(one, other)) == {SIZE, MASS}


def test_real_files_are_written_back_byte_for_byte(corpus: Path):
    seen = 0
    for path in sorted(corpus.rglob("*.xacro"))[::12]:
        data = path.read_bytes()
        named = NamedTexts(path.name, str(path), data)
        assert named.with_texts({})[0] == data
        assert named.differing(data) == {}
        seen += 1
    assert seen > 20
