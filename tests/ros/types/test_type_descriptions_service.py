from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.types.library import TypeLibrary
from studio.ros.types.type_descriptions import DESCRIPTION_SERVICE_TYPE, fill_description

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue

LIBRARY = TypeLibrary("jazzy")
SERVICE = LIBRARY.service(DESCRIPTION_SERVICE_TYPE)
TWIST = "geometry_msgs/msg/Twist"


def answer(name: str, type_hash: str = "", *, with_texts: bool = True) -> MessageValue:
    request = SERVICE.Request(type_name=name, type_hash=type_hash, include_type_sources=with_texts)
    return fill_description(LIBRARY, request, SERVICE.Response())


def test_a_type_is_told_whole_with_the_texts_it_was_made_from():
    response = answer(TWIST, LIBRARY.hash_of(TWIST))
    assert (response.successful, response.failure_reason) == (True, "")
    parts = response.type_description.referenced_type_descriptions
    assert [one.type_name for one in parts] == ["geometry_msgs/msg/Vector3"]
    assert [one.type_name for one in response.type_sources] == [
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/Vector3",
    ]


def test_texts_are_left_out_when_nobody_wants_them():
    assert answer(TWIST, with_texts=False).type_sources == []


@pytest.mark.parametrize(
    ("name", "type_hash", "reason"),
    [
        (TWIST, "RIHS01_" + "0" * 64, "has the hash RIHS01_9c45bf"),
        ("no_pkg/msg/None", "", "no known package defines it"),
        ("nonsense", "", "cannot be used in ROS 2"),
        ("", "", "cannot be used in ROS 2"),
        ("a/msg/" + "B" * 100_000, "", "cannot be used"),
    ],
)
def test_what_cannot_be_told_has_a_reason(name: str, type_hash: str, reason: str):
    response = answer(name, type_hash)
    assert not response.successful
    assert reason in response.failure_reason
    assert len(response.failure_reason) < 1_000
