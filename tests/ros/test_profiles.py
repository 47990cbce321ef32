from __future__ import annotations

import pytest

from studio.errors import RosNameError
from studio.ros.profiles import HUMBLE, JAZZY, KILTED, profile_named


def test_humble_has_a_constant_where_others_have_a_hash():
    assert HUMBLE.type_hash("RIHS01_0") == "TypeHashNotSupported"
    assert JAZZY.type_hash("RIHS01_0") == KILTED.type_hash("RIHS01_0") == "RIHS01_0"


def test_a_distribution_is_found_by_name_in_any_case():
    assert profile_named("Jazzy") is JAZZY


def test_an_unknown_distribution_is_refused_and_the_known_ones_are_named():
    with pytest.raises(RosNameError, match="humble, jazzy, kilted"):
        profile_named("groovy")
