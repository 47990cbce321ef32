"""Broken texts are read as far as they go, and mended where it is clear what was meant."""

from __future__ import annotations

import random
import time
from contextlib import suppress
from functools import cache
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from studio.description.editing.edits import apart, apply, edits_of
from studio.description.syntax.recovery import Recovered, recover
from studio.description.syntax.source_tree import SourceError, SourceTree, parse_source
from studio.description.syntax.xml_faults import FAULTS_LIMIT
from studio.settings import repository_or_wheel
from tests.support.sweep import some_of

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
LINK = '<link name="a"/>'


def read(text: str) -> Recovered:
    return recover("r.xacro", text.encode())


def found(text: str) -> list[tuple[str, int, int]]:
    return [(one.code, one.place.line, one.place.column) for one in read(text).faults]


def mended(text: str) -> str:
    """The text with all fixes made at once."""
    data = text.encode()
    fixes = [one.fix.edits for one in read(text).faults if one.fix]
    return apply(data, edits_of(apart(fixes), lambda _: data)).decode()


def elements(tree: SourceTree) -> list[tuple[object, ...]]:
    return [
        (one.tag, one.attributes, one.place.line, one.place.column, one.offset, one.ordinal)
        for one in tree.elements
    ]


BROKEN = {
    "no end of the robot": (
        f'<robot name="r">\n  {LINK}\n',
        [("xml-open-element", 2, 18)],
        f'<robot name="r">\n  {LINK}\n</robot>\n',
    ),
    "no end of an inner element": (
        '<robot><link name="a"><visual></link></robot>',
        [("xml-open-element", 1, 23)],
        '<robot><link name="a"><visual></visual></link></robot>',
    ),
    "a link in a link": (
        '<robot>\n  <link name="a">\n    <visual>\n  <link name="b"/>\n</robot>',
        [("xml-open-element", 3, 5), ("xml-open-element", 2, 3)],
        '<robot>\n  <link name="a">\n    <visual>\n    </visual>\n  </link>\n'
        '  <link name="b"/>\n</robot>',
    ),
    "an element that holds no others": (
        '<robot><joint name="j"><origin xyz="0 0 0"><parent link="a"/></joint></robot>',
        [("xml-open-element", 1, 24)],
        '<robot><joint name="j"><origin xyz="0 0 0"/><parent link="a"/></joint></robot>',
    ),
    "another end tag": (
        '<robot><link name="a"></lnik></robot>',
        [("xml-end-tag", 1, 23)],
        '<robot><link name="a"></link></robot>',
    ),
    "a stray end tag": (f"<robot>{LINK}</pre></robot>", [("xml-end-tag", 1, 24)], None),
    "a stray end tag within a tag": (
        '<robot><mesh filename="m" scale=</pre>\n  "1 1 1"/></robot>',
        [("xml-attribute", 1, 33)],
        '<robot><mesh filename="m" scale=\n  "1 1 1"/></robot>',
    ),
    "text behind the end": (f"<robot>{LINK}</robot>\n```\n", [("xml-after-end", 2, 1)], None),
    "text before the start": (f"```xml\n<robot>{LINK}</robot>", [("xml-not-first", 1, 1)], None),
    "an empty line before the declaration": (
        f"\n<?xml version='1.0'?><robot>{LINK}</robot>",
        [("xml-not-first", 1, 1)],
        f"<?xml version='1.0'?><robot>{LINK}</robot>",
    ),
    "elements behind the end": (
        f'<robot>{LINK}</robot><link name="b"/>',
        [("xml-after-end", 1, 32)],
        f'<robot>{LINK}<link name="b"/>\n</robot>\n',
    ),
    "no robot around": (
        f'{LINK}\n<link name="b"/>\n',
        [("xml-no-root", 1, 1), ("xml-open-element", 2, 16)],
        f'<robot name="robot">\n{LINK}\n<link name="b"/>\n</robot>\n',
    ),
    "a value without quotes": (
        "<robot><link name=a/></robot>",
        [("xml-attribute", 1, 19)],
        f"<robot>{LINK}</robot>",
    ),
    "an attribute without a value": (
        '<robot><link name="a" type/></robot>',
        [("xml-attribute", 1, 23)],
        f"<robot>{LINK}</robot>",
    ),
    "no = between name and value": (
        '<robot><link name"a"/></robot>',
        [("xml-attribute", 1, 18)],
        f"<robot>{LINK}</robot>",
    ),
    "no blank between attributes": (
        '<robot><link name="a"type="b"/></robot>',
        [("xml-attribute", 1, 22)],
        '<robot><link name="a" type="b"/></robot>',
    ),
    "a blank in />": (
        '<robot><link name="a"/ ></robot>',
        [("xml-attribute", 1, 22)],
        f"<robot>{LINK}</robot>",
    ),
    "a blank behind <": (
        '<robot>< link name="a"/></robot>',
        [("xml-tag-name", 1, 8)],
        f"<robot>{LINK}</robot>",
    ),
    "a quote that is never closed": (
        '<robot><link name="a/>\n<link name="b"/></robot>',
        [("xml-open-quote", 1, 19)],
        f'<robot>{LINK}\n<link name="b"/></robot>',
    ),
    "a quote that another attribute ends": (
        '<robot><link name="a type="b"/></robot>',
        [("xml-open-quote", 1, 19)],
        '<robot><link name="a" type="b"/></robot>',
    ),
    "a tag that is never closed": (
        '<robot><mesh filename="a"\n<link name="b"/></robot>',
        [("xml-open-tag", 1, 8)],
        '<robot><mesh filename="a"/>\n<link name="b"/></robot>',
    ),
    "a tag cut off at its slash": (
        '<robot><link name="a"/',
        [("xml-open-tag", 1, 8), ("xml-open-element", 1, 22)],
        f"<robot>{LINK}\n</robot>",
    ),
    "a < in a value": (
        f'<robot {XACRO}><xacro:if value="${{1 < 2}}"/></robot>',
        [("xml-less-than", 1, 73)],
        f'<robot {XACRO}><xacro:if value="${{1 &lt; 2}}"/></robot>',
    ),
    "an attribute twice": (
        '<robot><link name="a" name="b"/></robot>',
        [("xml-attribute-twice", 1, 23)],
        f"<robot>{LINK}</robot>",
    ),
    "xacro that nobody declares": (
        '<robot name="r"><xacro:property name="p" value="1"/></robot>',
        [("xml-unbound-prefix", 1, 17)],
        f'<robot {XACRO} name="r"><xacro:property name="p" value="1"/></robot>',
    ),
    "xacro misspelt": (
        f'<robot {XACRO}><xarco:if value="1"></xarco:if></robot>',
        [("xml-unbound-prefix", 1, 52), ("xml-end-tag", 1, 72)],
        f'<robot {XACRO}><xacro:if value="1"></xacro:if></robot>',
    ),
    "an & alone": (
        '<robot><link name="a & b"/></robot>',
        [("xml-ampersand", 1, 22)],
        '<robot><link name="a &amp; b"/></robot>',
    ),
    "dashes in a comment": (
        "<robot><!-- a -- b --></robot>",
        [("xml-comment", 1, 8)],
        "<robot><!-- a - b --></robot>",
    ),
    "CRLF and a byte order mark": (
        '\ufeff<robot>\r\n  <link name="a">\r\n  <link name="b"/>\r\n</robot>',
        [("xml-open-element", 2, 3)],
        '\ufeff<robot>\r\n  <link name="a">\r\n  </link>\r\n  <link name="b"/>\r\n</robot>',
    ),
}


@pytest.mark.parametrize(("text", "faults", "whole"), BROKEN.values(), ids=BROKEN.keys())
def test_each_fault_is_named_at_its_place_and_mended(
    text: str, faults: list[tuple[str, int, int]], whole: str | None
):
    assert found(text) == faults
    result = mended(text)
    parse_source("r.xacro", result.encode())
    if whole is not None:
        assert result == whole


@pytest.mark.parametrize("text", [text for text, _, _ in BROKEN.values()], ids=BROKEN.keys())
def test_what_is_read_of_a_broken_text_is_what_the_mended_one_holds(text: str):
    read_now = [(one.tag, one.attributes) for one in read(text).tree.elements]
    after = parse_source("r.xacro", mended(text).encode()).elements
    declared = {name: text for one in after for name, text in one.attributes.items()}
    for (tag, attributes), one in zip(read_now, after, strict=True):
        assert tag == one.tag
        assert {**attributes, **{n: t for n, t in declared.items() if n == "xmlns:xacro"}} == {
            **one.attributes,
            **{n: t for n, t in declared.items() if n == "xmlns:xacro"},
        }


def test_a_comment_and_a_section_that_never_end_are_told_and_left_to_the_user():
    for text, code in (
        ("<r><a/><!-- x</r>", "xml-open-comment"),
        ("<r><![CDATA[", "xml-open-cdata"),
    ):
        first = read(text).faults[0]
        assert (first.code, first.fix) == (code, None)


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (b"", "file-empty"),
        (b"just text", "xml-malformed"),
        (b"<!DOCTYPE r [<!ENTITY a 'b'>]><r>&a;<x", "xml-entity"),
        (b"<a>" * 300, "xml-too-deep"),
        (b"\0\1\2<robot", "file-binary"),
    ],
)
def test_what_cannot_be_read_at_all_is_refused_as_before(data: bytes, code: str):
    with pytest.raises(SourceError) as refused:
        recover("r.xacro", data)
    assert refused.value.code == code


@cache
def samples() -> tuple[bytes, ...]:
    files = sorted(Path(repository_or_wheel("models")).rglob("*.xacro"))
    return tuple(file.read_bytes() for file in files)


@settings(max_examples=150, deadline=None)
@given(st.data())
def test_whatever_is_cut_off_or_left_out_is_read_without_a_crash(data: st.DataObject):
    text = data.draw(st.sampled_from(samples()))
    at = data.draw(st.integers(0, len(text) - 1))
    broken = text[:at] if data.draw(st.booleans()) else text[:at] + text[at + 1 :]
    check_broken(broken)


def check_broken(broken: bytes) -> None:
    """It is read or refused, every fix finds its place, and places lie within the text."""
    try:
        recovered = recover("r.xacro", broken)
    except SourceError:
        return
    lines = broken.count(b"\n") + 1
    for fault in recovered.faults:
        assert 1 <= fault.place.line <= lines
        assert fault.sentence.endswith((".", "?", ")", ":"))
        if fault.fix:
            apply(broken, edits_of(fault.fix.edits, lambda _: broken))


def test_a_well_formed_text_gives_what_the_strict_reader_gives():
    for text in samples():
        recovered = recover("r.xacro", text)
        assert not recovered.faults
        assert elements(recovered.tree) == elements(parse_source("r.xacro", text))


@pytest.mark.corpus
def test_files_of_the_corpus_are_read_whatever_is_left_out_of_them(corpus: Path):
    chance = random.Random(7)
    for file in chance.sample(sorted(corpus.rglob("*.xacro")), 60):
        text = file.read_bytes()
        for _ in range(10):
            at = chance.randrange(max(len(text), 1))
            check_broken(text[:at])
            check_broken(text[:at] + text[at + 1 :])


HOSTILE = {
    "ampersands": b"<r>" + b"&" * 2_000_000,
    "quotes": b'<r a="' + b"x' y=\"" * 200_000,
    "blanks in a value": b"<r a='" + b" " * 2_000_000 + b"b = ",
    "open tags": b"<r>" + b"<a " * 300_000,
    "end tags": b"<r>" + b"</a>" * 300_000,
    "no end": b"<r " + b"a" * 3_000_000,
    "attributes": b"<r " + b" ".join(b"a%d=1" % n for n in range(200_000)),
    "one line": b"<r>" + b'<a b="c"/>' * 100_000,
    "comments": b"<r>" + b"<!-- -- " * 300_000,
}


@pytest.mark.parametrize("data", some_of(HOSTILE.values()), ids=HOSTILE.keys())
def test_hostile_texts_cost_little_and_give_few_faults(data: bytes):
    began_s = time.process_time()
    with suppress(SourceError):
        assert len(recover("r.xacro", data).faults) <= FAULTS_LIMIT
    assert time.process_time() - began_s < 10
