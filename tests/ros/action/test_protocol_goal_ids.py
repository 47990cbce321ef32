from __future__ import annotations

import pytest

from studio.ros.action.protocol import goal_id_message, goal_id_of, new_goal_id
from studio.ros.types.library import TypeLibrary

LIBRARY = TypeLibrary("jazzy")


def test_an_id_survives_its_message():
    goal_id = new_goal_id()
    assert goal_id_of(goal_id_message(LIBRARY, goal_id)) == goal_id


def test_no_two_ids_are_the_same():
    assert len({new_goal_id() for _ in range(100)}) == 100


def test_an_id_of_another_length_is_refused():
    with pytest.raises(ValueError, match="16 bytes"):
        goal_id_message(LIBRARY, b"short")
