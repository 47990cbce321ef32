from __future__ import annotations

import json

from studio.ros.messages import message
from studio.ros.types.convert import plain_json, to_json


def test_numbers_that_a_page_cannot_hold_become_texts():
    values = {"big": 2**53 + 1, "exact": 2**53, "no": float("nan"), "least": float("-inf")}
    told = json.loads(plain_json(values))
    assert told == {"big": str(2**53 + 1), "exact": 2**53, "no": "nan", "least": "-inf"}


def test_a_long_message_is_cut_to_what_is_asked_for_and_says_so():
    points = message("std_msgs/msg/Float64MultiArray")(data=[0.5] * 100_000)
    written = to_json(points, 5_000)
    assert len(written) <= 5_000
    assert json.loads(written)["data"][-1] == "..."


def test_what_is_short_is_whole():
    twist = message("geometry_msgs/msg/Twist")()
    twist.linear.x = 2.0
    assert json.loads(to_json(twist, 10_000))["linear"] == {"x": 2.0, "y": 0.0, "z": 0.0}


def test_letters_of_every_kind_survive():
    text = 'ä"\\\n\u2028\ud800'
    assert json.loads(plain_json([text, b"\xff"])) == [text, "\xff"]
