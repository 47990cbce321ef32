"""What is said of an expression that fails, in words that do not ask for Python."""

from __future__ import annotations

import pytest

from studio.description.evaluator.texts import pure_value
from studio.description.faults import Fault


@pytest.mark.parametrize("text", ["1.28 * ''", "1 + 'a'", "sin('a')", "-'a'", "1 < 'a'"])
def test_a_text_in_place_of_a_number_is_told_as_such(text: str):
    with pytest.raises(Fault, match="a text stands where a number is needed"):
        pure_value(text)


def test_other_failures_keep_their_reason():
    with pytest.raises(Fault, match="division by zero"):
        pure_value("1 / 0")
