from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.problems import Severity
from tests.support.checked_texts import checked, mended
from tests.support.descriptions import robot

if TYPE_CHECKING:
    from pathlib import Path

LINK = '<link name="a"/>'


def prop(name: str, value: str = "1") -> str:
    return f'<xacro:property name="{name}" value="{value}"/>'


def test_a_property_and_an_arg_that_nothing_reads_are_noted_and_removed(tmp_path: Path):
    body = f'{prop("old")}\n<xacro:arg name="gone" default=""/>\n{LINK}'
    problems = checked(tmp_path, body)
    assert [one.code for one in problems] == ["unused-property", "unused-arg"]
    assert all(one.severity is Severity.INFO for one in problems)
    assert mended(tmp_path, problems) == LINK


@pytest.mark.parametrize(
    "reader",
    [
        '<link name="${p}"/>',
        '<link name="a"/><xacro:if value="${1 == 2}"><link name="${p}"/></xacro:if>',
        '<xacro:macro name="m" params="p:=^"/><link name="a"/>',
        '<xacro:macro name="m" params=""><link name="${p + 1}"/></xacro:macro><link name="a"/>',
        '<xacro:property name="q" value="${p}"/><link name="${q}"/>',
        "<link name='a'><x>${p}</x></link>",
    ],
)
def test_what_is_mentioned_anywhere_counts_as_read(tmp_path: Path, reader: str):
    assert checked(tmp_path, f"{prop('p')}\n{reader}") == ()


def test_many_of_one_file_are_one_finding_at_the_way_to_it(tmp_path: Path):
    library = robot("\n".join(prop(f"p{n}") for n in range(8)))
    (problem,) = checked(tmp_path, f'<xacro:include filename="b.xacro"/>{LINK}', b=library)
    assert problem.sentence.startswith('Nothing reads 8 properties ("p0", "p1",')
    assert problem.place is not None
    assert problem.place.file.endswith("b.xacro")
    assert [place.file for place in problem.include_chain] == [str(tmp_path / "r.xacro")]
    assert problem.fix is not None
    assert len(problem.fix.edits) == 8
