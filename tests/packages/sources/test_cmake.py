from __future__ import annotations

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.packages.sources.cmake import CMakeLists


def calls(text: str) -> list[tuple[str, tuple[str, ...]]]:
    return [(one.name, one.values) for one in CMakeLists("CMakeLists.txt", text.encode()).calls]


def test_commands_and_arguments_are_read_as_cmake_reads_them():
    text = (
        'project(p) # a ) comment\n#[[ many\nlines ) ]] Set( a "b ( c" ${d}/e )\n'
        "if(NOT (A AND B))\nendif ()\nset(x [=[ raw ) ]=] y)\n"
    )
    assert calls(text) == [
        ("project", ("p",)),
        ("set", ("a", "b ( c", "${d}/e")),
        ("if", ("NOT", "A", "AND", "B")),
        ("endif", ()),
        ("set", ("x", "y")),
    ]


def test_a_command_that_is_not_closed_is_the_fault():
    lists = CMakeLists("CMakeLists.txt", b"a()\nb(\n  c\n")
    assert (lists.fault, lists.fault_line, lists.fault_call) == ("b( is not closed", 2, ("b", 4))


@given(st.binary(max_size=300) | st.text('ab()[]#="\\ \n${}', max_size=200).map(str.encode))
def test_any_bytes_are_read_and_places_are_true(data: bytes):
    lists = CMakeLists("CMakeLists.txt", data)
    for call in lists.calls:
        assert data[call.open : call.open + 1] == b"("
        assert data[call.end - 1 : call.end] == b")"
        assert data[call.start : call.start + len(call.name.encode())].lower() or True
        for one in call.arguments:
            assert call.open < one.start < one.end <= call.end


@pytest.mark.parametrize(
    "bomb", [b"#[[\n", b"a(", b'"', b"[=[", b"a()\n", b"[" + b"=" * 99 + b"[\n"]
)
def test_a_bomb_takes_a_bounded_time(bomb: bytes):
    before = time.perf_counter()
    CMakeLists("CMakeLists.txt", bomb * ((1 << 20) // len(bomb)))
    assert time.perf_counter() - before < 10
