from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.checked_texts import checked, mended

if TYPE_CHECKING:
    from pathlib import Path

TIE = '<parent link="a"/><child link="{}"/>'


def body(first: str, second: str) -> str:
    return (
        '<link name="a"/>\n<link name="b"/>\n<link name="c"/>\n'
        f'<joint name="{first}" type="fixed">{TIE.format("b")}</joint>\n'
        f'<joint name="{second}" type="fixed">{TIE.format("c")}</joint>'
    )


def test_the_second_joint_of_a_name_gets_a_free_one(tmp_path: Path):
    (problem,) = problems = checked(tmp_path, body("j", "j"))
    assert (problem.code, problem.parts) == ("duplicate-joint", ("joint:j#2",))
    assert problem.place is not None
    assert problem.place.line == 6
    assert mended(tmp_path, problems) == body("j", "j_2")
    assert checked(tmp_path, body("j", "j_2")) == ()


def test_each_of_several_links_gets_a_name_that_is_not_taken(tmp_path: Path):
    names = ["w", "w_2", "w", "w"]
    problems = checked(tmp_path, "\n".join(f'<link name="{name}"/>' for name in names))
    repeats = tuple(one for one in problems if one.code == "duplicate-link")
    result = mended(tmp_path, repeats)
    assert result.splitlines() == [f'<link name="{n}"/>' for n in ("w", "w_2", "w_3", "w_4")]


@pytest.mark.parametrize("name", ["w", "${n}"])
def test_what_a_macro_writes_twice_is_told_and_not_renamed(tmp_path: Path, name: str):
    macro = f'<xacro:macro name="wheel" params="n"><link name="{name}"/></xacro:macro>'
    problems = checked(tmp_path, f'{macro}\n<xacro:wheel n="w"/>\n<xacro:wheel n="w"/>')
    (repeat,) = (one for one in problems if one.code == "duplicate-link")
    assert repeat.fix is None
    assert [call.macro for call in repeat.macro_stack] == ["wheel"]
