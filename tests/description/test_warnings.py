"""We warn on the occasions on which xacro warns, each with its place; else neither says a word."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.descriptions import evaluation_of, policy_for, robot, stock_text, write

if TYPE_CHECKING:
    from pathlib import Path

LIBRARY = robot("<x/>", 'xmlns:g="http://library"')
OCCASIONS: dict[str, tuple[str, str]] = {
    "a property hides a name of xacro": ('<xacro:property name="pi" value="3"/>', "hides-builtin"),
    "a lazy one, too": ('<xacro:property name="e" value="${1+1}"/>', "hides-builtin"),
    "a parameter hides a name of xacro": (
        '<xacro:macro name="m" params="len"/><xacro:m len="1"/>',
        "hides-builtin",
    ),
    "a default hides a name of xacro": (
        '<xacro:macro name="m" params="len:=1"/><xacro:m/>',
        "hides-builtin",
    ),
    "a namespace hides a name of xacro": (
        '<xacro:include filename="b.xacro" ns="math"/>',
        "hides-builtin",
    ),
    "a name of xacro is removed": ('<xacro:property name="pi" remove="true"/>', "hides-builtin"),
    "a default with a scope": (
        '<xacro:property name="a" default="1" scope="global"/>',
        "default-scope",
    ),
    "an unknown attribute of a property": (
        '<xacro:property name="a" value="1" vlaue="2"/>',
        "unknown-attribute",
    ),
    "an unknown attribute of an arg": (
        '<xacro:arg name="a" default="1" help="x"/>',
        "unknown-attribute",
    ),
    "an unknown attribute of a macro": (
        '<xacro:macro name="m" parms="a"><x/></xacro:macro>',
        "unknown-attribute",
    ),
    "an unknown attribute of a condition": (
        '<xacro:if value="1" name="x"><x/></xacro:if>',
        "unknown-attribute",
    ),
    "an unknown attribute of a block": (
        '<xacro:property name="b"><x/></xacro:property><xacro:insert_block name="b" at="1"/>',
        "unknown-attribute",
    ),
    "an unknown attribute of an include": (
        '<xacro:include filename="b.xacro" file="c"/>',
        "unknown-attribute",
    ),
    "elements inside an include": (
        '<xacro:include filename="b.xacro"><x/></xacro:include>',
        "include-children",
    ),
    "a pattern that matches nothing": (
        '<xacro:include filename="none*.xacro"/>',
        "include-no-match",
    ),
    "a prefix of two meanings": (
        '<y xmlns:g="http://other"><xacro:include filename="b.xacro"/></y>',
        "namespace-conflict",
    ),
    "a macro with xacro's prefix": (
        '<xacro:macro name="xacro:m"><x/></xacro:macro><xacro:m/>',
        "macro-name",
    ),
    "a deprecated function of python": ('<x v="${list(range(2))}"/>', "xacro-deprecated"),
    "a deprecated function of xacro": ("<x v=\"${load_yaml('c.yaml')}\"/>", "xacro-deprecated"),
    "the file warns": ("<x v=\"${xacro.warning('careful')}\"/>", "xacro-warning"),
    "the file warns of an error": ("<x v=\"${xacro.error('bad')}\"/>", "xacro-error"),
}
SILENT = {
    "a prefix among the attributes": '<xacro:if value="1" xmlns:k="http://k"><x/></xacro:if>',
    "a name that is defined twice": (
        '<xacro:property name="a" value="1"/><xacro:property name="a" value="2"/>'
    ),
    "a macro that is defined twice": '<xacro:macro name="m"/><xacro:macro name="m"/>',
    "a namespaced function": '<x v="${list(python.range(2))}"/>',
    "a default without a scope": '<xacro:property name="a" default="1"/>',
}
FILES = {"b.xacro": LIBRARY, "c.yaml": "k: 1\n"}


@pytest.mark.parametrize("case", OCCASIONS)
def test_a_warning_of_xacro_is_a_problem_with_its_place(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    body, code = OCCASIONS[case]
    file = write(tmp_path, {"a.xacro": robot(f"\n{body}"), **FILES})
    assert stock_text(file) is not None, "stock xacro cannot expand the case"
    assert _said_by_stock(capsys), "stock xacro does not warn"
    run = evaluation_of(policy_for(tmp_path))
    run.run(str(file))
    (warning,) = run.texts.warnings
    assert (warning.code, warning.place and warning.place.line) == (code, 2)


@pytest.mark.parametrize("case", SILENT)
def test_where_xacro_is_silent_so_are_we(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
):
    file = write(tmp_path, {"a.xacro": robot(SILENT[case]), **FILES})
    assert stock_text(file) is not None, "stock xacro cannot expand the case"
    assert not _said_by_stock(capsys)
    run = evaluation_of(policy_for(tmp_path))
    run.run(str(file))
    assert not run.texts.warnings


def _said_by_stock(capsys: pytest.CaptureFixture[str]) -> bool:
    said = capsys.readouterr().err
    return "warning: " in said or "error: " in said
