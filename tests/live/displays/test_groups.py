from __future__ import annotations

import pytest

from studio.errors import CommandError
from studio.live.displays.groups import DEPTH_MAX, all_groups, group_path, groups_to, is_within


def test_a_path_is_kept_without_empty_names_and_spaces_around_them():
    assert group_path(" Nav / /Local costmap/ ") == "Nav/Local costmap"
    assert group_path(" / ") == ""
    assert group_path("/".join("a" * DEPTH_MAX)) == "/".join("a" * DEPTH_MAX)
    with pytest.raises(CommandError):
        group_path("/".join("a" * (DEPTH_MAX + 1)))


def test_groups_are_known_with_those_around_them():
    assert groups_to("A/B/C") == ("A", "A/B", "A/B/C")
    assert groups_to("") == ()
    assert all_groups(["A/B", "", "C"]) == {"A", "A/B", "C"}


def test_a_group_of_a_longer_name_is_not_within():
    assert is_within("A/B", "A")
    assert is_within("A", "A")
    assert not is_within("AB/C", "A")
