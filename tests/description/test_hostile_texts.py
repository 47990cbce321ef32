"""Files that are odd as texts: encodings, declarations, depths, characters that XML cannot hold.

In a real worker process, the next robot after each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.description.values import Expansion
from tests.support.descriptions import XMLNS, robot, write
from tests.support.hostile import (
    WITHIN_S,
    HostileStudio,
    expression,
    loaded,
    properties,
    stopped,
)

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path


BODY = robot('<x v="${1}"/>')


def declared(encoding: str, data: bytes | str = BODY) -> bytes:
    """A file that says what encoding it is in."""
    text = data.encode(encoding) if isinstance(data, str) else data
    return f'<?xml version="1.0" encoding="{encoding}"?>'.encode() + text


NOT_ASCII = f"<robot {XMLNS} name='".encode() + b"\xe4'/>"
REFUSED: dict[str, Mapping[str, str | bytes]] = {
    **{
        f"declared as {name}": {"a.xacro": declared(name, NOT_ASCII)}
        for name in (
            *("utf-8", "ascii", "idna", "punycode", "undefined", "utf-7"),
            *("bz2", "zlib", "hex", "rot13", "base64", "no-such", "utf-16"),
            *("utf-32", "cp037", "mbcs", "shift_jis", "../../etc/passwd"),
        )
    },
    "written in UTF-16": {"a.xacro": BODY.encode("utf-16")},
    "written in UTF-16 without a mark": {"a.xacro": BODY.encode("utf-16-be")},
    "written in UTF-32": {"a.xacro": BODY.encode("utf-32")},
    "written in UTF-7": {"a.xacro": "+ADw-robot/+AD4-"},
    "written in EBCDIC": {"a.xacro": BODY.encode("cp037")},
    "null bytes": {"a.xacro": BODY.replace("name", "na\0me")},
    "null bytes far down": {"a.xacro": robot(" " * 200_000 + "\0")},
    "a reference to nothing": {"a.xacro": robot("&#0;")},
    "a reference to half a character": {"a.xacro": robot("&#xD800;")},
    "an unknown entity": {"a.xacro": robot("&nbsp;")},
    "an entity in an attribute": {
        "a.xacro": f'<!DOCTYPE r [<!ENTITY e "x">]><robot {XMLNS} name="&e;"/>'
    },
    "entities that hold entities": {
        "a.xacro": '<!DOCTYPE r [<!ENTITY a "&#38;b;"><!ENTITY b "x">]>' + robot("&a;")
    },
    "an entity that holds itself": {"a.xacro": '<!DOCTYPE r [<!ENTITY a "&a;">]>' + robot("&a;")},
    "two roots": {"a.xacro": BODY + BODY},
    "a cut comment": {"a.xacro": robot("<!-- ")},
    "a cut section": {"a.xacro": robot("<![CDATA[ ")},
    "a cut instruction": {"a.xacro": robot("<?x ")},
    "a section that ends twice": {"a.xacro": robot("<![CDATA[ ]]> ]]>")},
    "an instruction named xml": {"a.xacro": robot("<?xml version='1.0'?>")},
    "the same attribute twice": {"a.xacro": robot('<x a="1" a="2"/>')},
    "elements of many levels": {"a.xacro": robot("<a>" * 100_000)},
    "elements of many levels in each of many files": {
        "a.xacro": robot("<a>" * 200 + '<xacro:include filename="b.xacro"/>' + "</a>" * 200),
        "b.xacro": robot("<a>" * 200 + '<xacro:include filename="a.xacro"/>' + "</a>" * 200),
    },
    "parentheses of many levels": {"a.xacro": expression("(" * 9_000 + "1" + ")" * 9_000)},
    "brackets of many levels": {"a.xacro": expression("[" * 9_000 + "]" * 9_000)},
    "signs of many levels": {"a.xacro": expression("~" * 15_000 + "1")},
    "sums of many levels": {"a.xacro": expression("1" + "+1" * 9_000)},
    "powers of many levels": {"a.xacro": expression("1" + "**1" * 6_000)},
    "attributes of many levels": {"a.xacro": expression("a" + ".a" * 9_000)},
    "calls of many levels": {"a.xacro": expression("str(" * 4_000 + "1" + ")" * 4_000)},
    "an expression of many characters": {"a.xacro": expression("1" + " " * 30_000)},
    "a number of many digits": {"a.xacro": expression("9" * 10_000)},
    "an expression of no text": {"a.xacro": expression("")},
    "an expression of two lines": {"a.xacro": expression("1&#10;2")},
    "yaml in UTF-16": {
        "a.xacro": expression("xacro.load_yaml('c.yaml')"),
        "c.yaml": "k: 1\n".encode("utf-16"),
    },
    "yaml of null bytes": loaded("k: \0\n"),
    "yaml of a control character": loaded("k: \x07\n"),
    "yaml of two documents": loaded("a: 1\n---\nb: 2\n"),
    "yaml of a directive": loaded("%YAML 9.9\n---\na: 1\n"),
    "yaml that is cut": loaded('a: "b\n'),
    "a control character": {"a.xacro": expression("'\\x07'")},
    "a null character": {"a.xacro": expression("'\\x00'")},
    "half a character": {"a.xacro": expression("'\\ud800'")},
    "half a character in the file's own words": {
        "a.xacro": expression("xacro.fatal('half \\ud800 of it')")
    },
    "half a character by percent": {"a.xacro": expression("'%c' % 55296")},
    "half a character from yaml": loaded('k: "\\uD800"\n', ".k"),
    "a control character from yaml": loaded('k: "\\a"\n', ".k"),
    "a control character in a name": {
        "a.xacro": robot(properties(n="${'a\\x07'}") + '<link name="${n}"/>')
    },
    "a control character in a text": {"a.xacro": robot("<t>${'\\x07'}</t>")},
    "a control character in an element's name": {
        "a.xacro": robot("<xacro:element xacro:name=\"${'a\\x07'}\"/>")
    },
    "markup as an element's name": {
        "a.xacro": robot("<xacro:element xacro:name=\"${'a b=&quot;c&quot;'}\"/>")
    },
    "markup as an attribute's name": {
        "a.xacro": robot('<x><xacro:attribute name="a&gt;&lt;b" value="c"/></x>')
    },
}
HARMLESS: dict[str, tuple[Mapping[str, str | bytes], str]] = {
    "markup in a value": (
        {"a.xacro": expression("'&lt;/x>&lt;script>alert(1)&lt;/script>&amp;'")},
        '<x v="&lt;/x&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;"/>',
    ),
    "quotes in a value": ({"a.xacro": expression("'&quot;'")}, '<x v="&quot;"/>'),
    "lines in a value": ({"a.xacro": expression("'a\\n\\tb'")}, '<x v="a&#10;&#9;b"/>'),
    "half a character in a message": (
        {"a.xacro": expression("xacro.warning('\\ud800')")},
        '<x v=""/>',
    ),
    "an expression in a section": (
        {"a.xacro": robot("<x><![CDATA[${().__class__}]]></x>")},
        "<x>${().__class__}</x>",
    ),
    "an expression in an instruction": ({"a.xacro": robot("<?x ${1/0}?><x/>")}, "<x/>"),
    "an expression in a comment": ({"a.xacro": robot("<!-- ${1/0} --><x/>")}, "<x/>"),
    "a style sheet": (
        {"a.xacro": '<?xml-stylesheet href="file:///etc/passwd"?>' + robot("<x/>")},
        "<x/>",
    ),
    "a document type of a file": (
        {"a.xacro": '<!DOCTYPE robot SYSTEM "file:///etc/passwd">' + robot("<x/>")},
        "<x/>",
    ),
    "an include of another kind": (
        {
            "a.xacro": robot(
                '<i:include xmlns:i="http://www.w3.org/2001/XInclude" href="/etc/passwd"/>'
            )
        },
        '<i:include xmlns:i="http://www.w3.org/2001/XInclude" href="/etc/passwd"/>',
    ),
    "declared as UTF-7": ({"a.xacro": declared("utf-7", b"") + robot("<x/>").encode()}, "<x/>"),
    "declared as Latin-1": (
        {"a.xacro": declared("latin-1", robot('<x v="\xe4"/>'))},
        '<x v="\xe4"/>',
    ),
    "a mark of UTF-8": ({"a.xacro": "\ufeff" + robot("<x/>")}, "<x/>"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_it_is_refused_in_time_and_the_next_robot_opens(
    case: str, studio: HostileStudio, tmp_path: Path
):
    stopped(studio, REFUSED[case], tmp_path)


@pytest.mark.parametrize("case", HARMLESS)
def test_it_is_text_and_nothing_else(case: str, studio: HostileStudio, tmp_path: Path):
    files, expected = HARMLESS[case]
    answer, seconds = studio.open(write(tmp_path, files))
    assert isinstance(answer, Expansion), answer
    assert [part.xml for part in answer.changed_parts] == [expected]
    assert answer.evaluator == "studio"
    assert seconds < WITHIN_S
