from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.packages.skeleton import LENGTH_LIMIT, name_fault, robot_of


@pytest.mark.parametrize("name", ["ab", "my_rover_description", "r2d2", "a_1", "a" * LENGTH_LIMIT])
def test_names_that_ros_takes_are_taken(name: str):
    assert name_fault(name) == ""


@pytest.mark.parametrize(
    "name",
    [
        *("", "a", "Rover", "my rover", "my-rover", "2wheels", "_a", "a__b", "rover_", "räder"),
        *("a.b", "../x", "a/b", "a\0", "rover\n", "a" * (LENGTH_LIMIT + 1), "🤖🤖", "<b>", 'a"b'),
    ],
)
def test_other_names_are_refused_with_a_sentence(name: str):
    assert name_fault(name).endswith((".", "say."))


@given(st.text())
def test_a_good_name_is_never_more_than_a_name_of_a_file(name: str):
    if not name_fault(name):
        assert name.isascii()
        assert not set(name) & set("/\\.: \0")


def test_a_robot_is_called_as_its_package_without_the_ending():
    assert [robot_of(one) for one in ("my_rover_description", "arm", "_description")] == [
        "my_rover",
        "arm",
        "_description",
    ]
