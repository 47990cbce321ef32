from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.checked_texts import checked, mended

if TYPE_CHECKING:
    from pathlib import Path


def links(*names: str) -> str:
    return "\n".join(f'<link name="{name}"/>' for name in names)


def joint(parent: str, child: str, name: str = "j") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="fixed">{ends}</joint>'


def test_a_tree_has_nothing_to_say(tmp_path: Path):
    assert checked(tmp_path, f"{links('a', 'b')}\n{joint('a', 'b')}") == ()


@pytest.mark.parametrize(
    ("body", "codes", "whole"),
    [
        (
            f"{links('base', 'wheel')}\n{joint('base', 'weel')}",
            ["dangling-child"],
            f"{links('base', 'wheel')}\n{joint('base', 'wheel')}",
        ),
        (
            f"{links('base link', 'wheel')}\n{joint('base_link', 'wheel')}",
            ["dangling-parent"],
            f"{links('base_link', 'wheel')}\n{joint('base_link', 'wheel')}",
        ),
        (
            f"{links('base')}\n{joint('base', 'gripper')}",
            ["dangling-child"],
            f"{links('base')}\n{links('gripper')}\n{joint('base', 'gripper')}",
        ),
        (
            links("a", "b"),
            ["several-roots"],
            '<link name="a"/>\n<joint name="a_joint" type="fixed"><parent link="b"/>'
            '<child link="a"/></joint>\n<link name="b"/>',
        ),
    ],
)
def test_each_fault_is_told_once_and_mended(
    tmp_path: Path, body: str, codes: list[str], whole: str
):
    problems = checked(tmp_path, body)
    assert [one.code for one in problems] == codes
    result = mended(tmp_path, problems)
    if codes != ["several-roots"]:
        assert result == whole
    assert checked(tmp_path, result) == ()


def test_a_parent_that_is_nowhere_is_not_made_up(tmp_path: Path):
    (problem,) = checked(tmp_path, f"{links('a')}\n{joint('nowhere', 'a')}")
    assert (problem.code, problem.fix, problem.parts) == ("dangling-parent", None, ("joint:j",))
    assert problem.place is not None
    assert (problem.place.line, problem.place.column) == (3, 30)


def test_what_a_macro_writes_is_told_with_its_call_and_mended_in_the_macro(tmp_path: Path):
    body = (
        '<xacro:macro name="wheel" params="n">\n'
        '  <link name="${n}_link"/>\n'
        "</xacro:macro>\n"
        '<xacro:wheel n="left"/>\n<xacro:wheel n="right"/>'
    )
    (problem,) = problems = checked(tmp_path, body)
    assert 'the macro "wheel" makes 2 of them' in problem.sentence
    assert [call.macro for call in problem.macro_stack] == ["wheel"]
    assert problem.parts == ("link:left_link", "link:right_link")
    result = mended(tmp_path, problems)
    assert result.startswith('<link name="base_link"/>\n<xacro:macro')
    assert '<child link="${n}_link"/></joint>\n</xacro:macro>' in result
    assert checked(tmp_path, result) == ()


def test_an_expression_is_never_overwritten_by_a_name(tmp_path: Path):
    body = f'<xacro:property name="w" value="weel"/>\n{links("base", "wheel")}\n'
    (problem,) = checked(tmp_path, body + joint("base", "${w}"))
    assert 'did you mean "wheel"?' in problem.sentence
    assert problem.fix is None


@pytest.mark.parametrize("name", ["a\"b'c", "<b>", "🤖", "x" * 5000])
def test_names_of_any_kind_are_told_and_mended(tmp_path: Path, name: str):
    from xml.sax.saxutils import quoteattr

    body = f"{links('base')}\n{joint('base', 'X')}".replace('"X"', quoteattr(name))
    (problem,) = problems = checked(tmp_path, body)
    assert problem.code == "dangling-child"
    assert len(problem.sentence) < 500
    assert checked(tmp_path, mended(tmp_path, problems)) == ()
