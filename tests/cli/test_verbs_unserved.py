from __future__ import annotations

import pytest

from tests.support.command_line import studio


@pytest.mark.parametrize(
    "line",
    [
        "bag record /number -o bag1",
        "bag record -a",
        "bag play bag1 --loop",
        "bag info bag1",
    ],
)
def test_a_line_that_is_not_served_says_so_in_one_sentence(line: str):
    ran = studio(*line.split())
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("studio: studio ")
    assert "is not there yet: " in ran.err
    assert ran.err.count("\n") == 1


@pytest.mark.parametrize("line", ["launch -h", "bag -h", "bag record --help", "pkg create -h"])
def test_its_help_is_help(line: str):
    ran = studio(*line.split())
    assert ran.code == 0
    assert ran.out.startswith("usage: ")
