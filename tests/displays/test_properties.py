import pytest

from studio.displays.properties import Property, rgb_of
from studio.errors import DisplayPropertyError

ALPHA = Property("Alpha", "number", 1.0, "How opaque it is.", low=0.0, high=1.0)
STYLE = Property("Style", "choice", "Boxes", "What it looks like.", choices=("Boxes", "Tiles"))
DEPTH = Property("Depth", "whole", 5, "How many are kept.", low=1, high=100)
COLOUR = Property("Color", "colour", "#ff0000", "Of all points.")


def test_numbers_are_held_within_their_range():
    assert ALPHA.checked(7) == 1.0
    assert ALPHA.checked(float("-inf")) == 0.0
    assert DEPTH.checked(2.9) == 2
    assert DEPTH.checked(float("inf")) == 100


def test_a_whole_number_without_an_end_stays_what_it_was_at_first_when_it_would_have_none():
    assert Property("Keep", "whole", 7, "How many.").checked(float("inf")) == 7
    assert Property("Keep", "whole", 7, "How many.").checked(10**400) == 7
    assert Property("Least", "number", 0.5, "How much.").checked(float("inf")) == 0.5
    assert Property("Least", "number", 0.5, "How much.").checked(10**400) == 0.5


@pytest.mark.parametrize(
    ("one", "value"),
    [
        (ALPHA, True),
        (ALPHA, "1"),
        (ALPHA, float("nan")),
        (Property("On", "switch", True, "Whether."), 1),
        (STYLE, "Balls"),
        (COLOUR, "red"),
        (COLOUR, "x" * 2000),
    ],
)
def test_a_value_of_another_kind_is_refused_with_a_sentence(one: Property, value: object):
    with pytest.raises(DisplayPropertyError, match=rf"{one.name} .+, not .+\.$"):
        one.checked(value)


def test_a_colour_is_kept_in_small_letters_and_read_as_three_numbers():
    assert COLOUR.checked("#FF8800") == "#ff8800"
    assert rgb_of("#ff8800") == (255, 136, 0)
