"""What a mistake in a description is told as: one sentence, at its place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.descriptions import (
    fault_of,
    robot,
    stock,
    write,
)

if TYPE_CHECKING:
    from pathlib import Path

MISTAKES = {
    "undefined-property": (
        '<xacro:property name="wheel_radius" value="1"/>\n<x v="${wheel_radiu}"/>',
        'did you mean "wheel_radius"?',
        2,
    ),
    "undefined-argument": ('\n<x v="$(arg side)"/>', "side:=value", 2),
    "unknown-macro": (
        '<xacro:macro name="wheel"/>\n<xacro:weel/>',
        'did you mean "wheel"?',
        2,
    ),
    "unknown-parameter": (
        '<xacro:macro name="m" params="radius"/>\n\n<xacro:m radios="1"/>',
        'did you mean "radius"?',
        3,
    ),
    "missing-parameter": ('<xacro:macro name="m" params="a"/>\n<xacro:m/>', 'needs a="..."', 2),
    "missing-block": ('<xacro:macro name="m" params="*a"/>\n<xacro:m/>', "1 more element", 2),
    "unused-block": ('<xacro:macro name="m"/>\n<xacro:m><o/></xacro:m>', "takes no element <o>", 2),
    "unknown-block": ('\n<xacro:insert_block name="b"/>', 'no block "b"', 2),
    "file-unreadable": ('\n<xacro:include filename="no.xacro"/>', "does not exist", 2),
    "package-not-found": ('\n<xacro:include filename="$(find p_q)/a"/>', '"p_q" was not found', 2),
    "bad-expression": ('\n<x v="${1 +}"/>', '"1 +" is not valid', 2),
    "missing-attribute": ("\n<xacro:property/>", 'needs the attribute "name"', 2),
    "property-name": ('\n<xacro:property name="a b" value="1"/>', "must be a Python name", 2),
    "property-attributes": ('\n<xacro:property name="a" value="1" default="2"/>', "only one of", 2),
    "not-a-condition": ('\n<xacro:if value="maybe"/>', "neither true nor false", 2),
    "circular-property": (
        '<xacro:property name="a" value="${b}"/>\n<xacro:property name="b" value="${a}"/>'
        '<x v="${a}"/>',
        "a -> b -> a",
        2,
    ),
    "environment-missing": ('\n<x v="$(env STUDIO_NOT_SET)"/>', "$(optenv STUDIO_NOT_SET", 2),
    "bad-substitution": ('\n<x v="$(fnd a)"/>', "use $(find)", 2),
    "macro-name": ('\n<xacro:macro name="a.b"/>', "are taken", 2),
    "fatal": ("\n<x v=\"${xacro.fatal('no', 'way')}\"/>", "no way", 2),
    "empty-name": ("\n<xacro:element xacro:name=\"${''}\"/>", "empty name", 2),
}


@pytest.mark.parametrize("code", MISTAKES)
def test_a_mistake_is_one_sentence_with_its_line(code: str, tmp_path: Path):
    body, words, line = MISTAKES[code]
    file = write(tmp_path, {"a.xacro": robot(body)})
    fault = fault_of(file)
    assert fault.code == code
    assert words in fault.sentence
    assert fault.place is not None
    assert (fault.place.file, fault.place.line) == (str(file), line)
    assert stock(file) is None, "stock xacro expands what we refuse"


@pytest.mark.parametrize(
    ("expression", "reason"),
    [("1/0", "division by zero"), ("[1][5]", "out of range"), ("dict()['k']", "no key 'k'")],
)
def test_an_expression_that_fails_says_why(expression: str, reason: str, tmp_path: Path):
    file = write(tmp_path, {"a.xacro": robot(f'<x v="${{{expression}}}"/>')})
    fault = fault_of(file)
    assert fault.code == "bad-expression"
    assert reason in fault.sentence


def test_a_fault_deep_inside_tells_how_it_was_reached(tmp_path: Path):
    file = write(
        tmp_path,
        {
            "a.xacro": robot('\n<xacro:include filename="b.xacro"/>\n<xacro:outer/>'),
            "b.xacro": robot(
                '\n<xacro:macro name="inner" params="r"><x v="${r/0}"/></xacro:macro>\n'
                '<xacro:macro name="outer">\n<xacro:inner r="1"/></xacro:macro>',
                "",
            ),
        },
    )
    fault = fault_of(file)
    inner = str(tmp_path / "b.xacro")
    assert str(fault.place) == f"{inner}:2:38"
    assert [str(place) for place in fault.include_chain] == [f"{file}:2:1"]
    calls = [(call.macro, str(call.called_at)) for call in fault.macro_stack]
    assert calls == [("outer", f"{file}:3:1"), ("inner", f"{inner}:4:1")]


def test_a_lazy_property_is_blamed_where_it_is_written(tmp_path: Path):
    body = '\n<xacro:property name="a" value="${nope}"/>\n\n<x v="${a}"/>'
    fault = fault_of(write(tmp_path, {"a.xacro": robot(body)}))
    assert fault.place is not None
    assert fault.place.line == 2


def test_a_missing_package_can_be_chosen(tmp_path: Path):
    fault = fault_of(write(tmp_path, {"a.xacro": robot('<x v="$(find far_away)"/>')}))
    assert fault.package == "far_away"


def test_a_property_that_lost_its_value_is_told_as_a_block(tmp_path: Path):
    inside = '<xacro:property name="wheel_radius" alue="1"/>\n<x v="${wheel_radius}"/>'
    sentence = fault_of(write(tmp_path, {"r.xacro": robot(inside)})).sentence
    assert sentence == '"wheel_radius" names a block: give its property a value.'
    inside = '<xacro:property name="wheel_radius"><o/></xacro:property>\n<x v="${wheel_radiu}"/>'
    sentence = fault_of(write(tmp_path, {"r.xacro": robot(inside)})).sentence
    assert "did you mean" not in sentence
