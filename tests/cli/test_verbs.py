from __future__ import annotations

import pytest

from tests.support.command_line import studio


@pytest.mark.parametrize("line", ["launch -h", "bag -h", "bag record --help", "pkg create -h"])
def test_the_help_of_a_verb_is_help(line: str):
    ran = studio(*line.split())
    assert ran.code == 0
    assert ran.out.startswith("usage: ")
