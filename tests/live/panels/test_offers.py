from __future__ import annotations

import asyncio
import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from studio.errors import StudioError
from studio.live.connection.ros_connection import RosConnection
from studio.live.panels.ros_system import RosSystem
from studio.protocol.calls import GetActions, GetServices, ReadValues
from studio.settings import WireChoice
from tests.support.asked import ask_ros
from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from typing import Any

    from studio.protocol import Command

TWIST = "geometry_msgs/msg/Twist"


def asked(command: Command) -> Any:  # noqa: ANN401 - the answer
    """Ask a studio that has joined nothing."""
    ros = RosSystem(RosConnection(WireChoice("off")), Path("nowhere"))
    return asyncio.run(ask_ros(ros, command, Ear()))


def read(text: str, name: str = TWIST, place: int = 0) -> Any:  # noqa: ANN401 - what was read
    return json.loads(asked(ReadValues(name=name, text=text, place=place)).values)


def test_without_a_connection_nothing_is_offered():
    assert asked(GetServices(request=3)).services == ()
    assert asked(GetActions(request=3)).actions == ()


def test_yaml_is_read_as_it_stands_for_a_form_to_lay_over_its_defaults():
    assert read("{linear: {x: 2}}") == {"linear": {"x": 2}}
    assert read("") == {}
    words = "{header: auto, point: {x: .nan}}"
    assert read(words, "geometry_msgs/msg/PointStamped") == {
        "header": "auto",
        "point": {"x": "nan"},
    }
    assert read("{sum: 9007199254740993}", "example_interfaces/srv/AddTwoInts", 1) == {
        "sum": "9007199254740993"
    }


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{linear: {w: 1}}", r"Twist\.linear: it has no field 'w'"),
        ("{linear: {x: fast}}", r"Twist\.linear\.x"),
        ("[1, 2]", "is no set of fields"),
        ("{a: [", "no YAML"),
        ("a: &b 1\nc: *b", "references"),
    ],
)
def test_what_a_field_does_not_take_is_named(text: str, words: str):
    with pytest.raises(StudioError, match=words):
        read(text)


@pytest.mark.parametrize(("name", "place"), [("nowhere_at/msg/All", 0), (TWIST, 1)])
def test_a_type_or_a_part_that_there_is_not_is_said(name: str, place: int):
    with pytest.raises(StudioError, match=r"nowhere_at|no part 1"):
        read("{}", name, place)
