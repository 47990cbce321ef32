from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.checked_texts import checked, mended

if TYPE_CHECKING:
    from pathlib import Path

    from studio.problems import Problem


def links(names: str) -> str:
    return "\n".join(f'<link name="{name}"/>' for name in names)


def joint(name: str, *ends: str) -> str:
    return f'<joint name="{name}" type="fixed">{"".join(ends)}</joint>'


def parent(link: str) -> str:
    return f'<parent link="{link}"/>'


def child(link: str) -> str:
    return f'<child link="{link}"/>'


def of(problems: tuple[Problem, ...], code: str) -> tuple[Problem, ...]:
    return tuple(one for one in problems if one.code == code)


AB = joint("ab", parent("a"), child("b"))
BC = joint("bc", parent("b"), child("c"))


@pytest.mark.parametrize(
    ("names", "code", "joints", "whole"),
    [
        ("abc", "second-parent", (AB, joint("bc", parent("b"), child("b"))), (AB, BC)),
        ("ab", "second-parent", (AB, AB.replace("ab", "twice")), (AB,)),
        ("ab", "bad-element", (joint("ab", child("b")),), (AB,)),
        ("abc", "bad-element", (AB, joint("bc", parent("b"))), (AB, BC)),
        ("ab", "dangling-parent", (joint("ab", parent("nowhere"), child("b")),), (AB,)),
    ],
)
def test_the_only_link_that_can_be_meant_is_written(
    tmp_path: Path, names: str, code: str, joints: tuple[str, ...], whole: tuple[str, ...]
):
    problems = checked(tmp_path, "\n".join((links(names), *joints)))
    (problem,) = of(problems, code)
    assert problem.fix is not None
    result = mended(tmp_path, problems)
    lines = [line.strip() for line in "".join(result.split("\n")).split("</joint>") if line]
    assert "</joint>".join(lines) + "</joint>" == "".join((links(names), *whole)).replace("\n", "")
    assert checked(tmp_path, result) == ()


@pytest.mark.parametrize(
    ("names", "code", "joints"),
    [
        ("abcd", "second-parent", (AB, joint("x", parent("b"), child("b")))),
        ("ab", "second-parent", (AB, joint("x", parent("a"), child("b"), '<axis xyz="1 0 0"/>'))),
        (
            "ab",
            "second-parent",
            (AB, joint("x", parent("a"), child("b")), '<transmission joint="x"/>'),
        ),
        ("abc", "bad-element", (joint("x", child("b")),)),
        ("abc", "bad-element", (joint("x", parent("a")),)),
        ("ab", "bad-element", (joint("x", child("b"), '<parnt link="a"/>'),)),
        ("ab", "bad-element", (joint("x", child("b")), joint("y", child("a")))),
        ("abc", "dangling-parent", (joint("x", parent("nowhere"), child("b")),)),
    ],
)
def test_where_several_can_be_meant_nothing_is_guessed(
    tmp_path: Path, names: str, code: str, joints: tuple[str, ...]
):
    problems = checked(tmp_path, "\n".join((links(names), *joints)))
    assert all(one.fix is None for one in of(problems, code))


def test_what_a_macro_writes_is_left_as_it_is(tmp_path: Path):
    macro = (
        f'<xacro:macro name="tie" params="n">{joint("bc", parent("b"), child("b"))}</xacro:macro>'
    )
    body = "\n".join((links("abc"), AB, macro, '<xacro:tie n="1"/>'))
    assert all(one.fix is None for one in of(checked(tmp_path, body), "second-parent"))
