from __future__ import annotations

import math

import numpy as np
import pytest

from studio.errors import MessageValueError
from studio.ros.types.classes import check_message, check_scalar
from studio.ros.types.definitions import FieldType
from studio.ros.types.library import TypeLibrary

LIBRARY = TypeLibrary("jazzy")


@pytest.mark.parametrize(
    ("base", "value"),
    [
        ("float32", 1), ("float32", math.inf), ("float64", np.float32(1)), ("int8", np.int64(3)),
        ("bool", True), ("bool", np.bool_(1)), ("string", "é"), ("float64", True),
    ],
)  # fmt: skip
def test_what_can_be_sent_is_let_through(base: str, value: object):
    check_scalar(FieldType(base), value, "x")


@pytest.mark.parametrize(
    ("base", "value"),
    [
        ("float32", 1e39), ("float64", 10**400), ("float64", None), ("int8", "1"), ("int8", 1.0),
        ("int8", 128), ("bool", 1), ("bool", "true"), ("string", b"a"), ("string", None),
    ],
)  # fmt: skip
def test_what_cannot_is_refused(base: str, value: object):
    with pytest.raises(MessageValueError, match=r"^x: "):
        check_scalar(FieldType(base), value, "x")


def test_the_path_leads_to_the_field():
    path = LIBRARY.message("nav_msgs/msg/Path")
    pose = LIBRARY.message("geometry_msgs/msg/PoseStamped")()
    pose.pose.position.x = "far"
    with pytest.raises(MessageValueError, match=r"Path poses\[1\]\.pose\.position\.x"):
        check_message(path(poses=[LIBRARY.message("geometry_msgs/msg/PoseStamped")(), pose]))


def test_a_message_of_another_type_is_refused():
    pose = LIBRARY.message("geometry_msgs/msg/Pose")()
    pose.position = LIBRARY.message("geometry_msgs/msg/Vector3")()
    with pytest.raises(MessageValueError, match="is no geometry_msgs"):
        check_message(pose)
