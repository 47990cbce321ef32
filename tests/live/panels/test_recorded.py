"""What panels see of the system that a recording is of: its parameters at a moment."""

from __future__ import annotations

import asyncio
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import CommandError
from studio.live.panels.recorded import RecordedParameters
from studio.live.time.recording_source import RecordingSource
from studio.protocol.parameters import GetParameterNodes, GetParameters
from studio.ros.messages import message
from tests.support.memory_recording import MemoryRecording
from tests.support.transforms import S

if TYPE_CHECKING:
    from collections.abc import Generator

EVENTS = "/parameter_events"
BEGIN = 1_700_000_000 * S
_INTEGER = 2
"""As in rcl_interfaces/msg/ParameterType."""


def parameter(name: str, value: int = 0) -> Any:  # noqa: ANN401 - made of its definition
    kind, of_value = message("rcl_interfaces/msg/Parameter"), "rcl_interfaces/msg/ParameterValue"
    return kind(name=name, value=message(of_value)(type=_INTEGER, integer_value=value))


def say(made: MemoryRecording, at_s: float, node: str, **fields: Any) -> None:  # noqa: ANN401
    made.say(EVENTS, BEGIN + round(at_s * S), node=node, **fields)


def recording() -> MemoryRecording:
    """A node has two parameters, changes one and gets one, then loses one; another comes late."""
    made = MemoryRecording()
    made.add_topic("/clock", "rosgraph_msgs/msg/Clock")
    made.say("/clock", BEGIN)
    made.add_topic(EVENTS, "rcl_interfaces/msg/ParameterEvent")
    say(made, 1.0, "/arm", new_parameters=[parameter("speed", 1), parameter("gain", 5)])
    say(
        made,
        2.0,
        "/arm",
        changed_parameters=[parameter("speed", 2)],
        new_parameters=[parameter("limit", 9)],
    )
    say(made, 3.0, "/arm", deleted_parameters=[parameter("gain")])
    say(made, 3.0, "/base", new_parameters=[parameter("wheels", 4)])
    made.say("/clock", BEGIN + 4 * S)
    return made


@contextmanager
def source(made: MemoryRecording) -> Generator[RecordingSource]:
    opened = RecordingSource(made)
    try:
        yield opened
    finally:
        opened.close()


def go_to(opened: RecordingSource, at_s: float) -> None:
    done = threading.Event()
    opened.jump(BEGIN + round(at_s * S), lambda _: done.set())
    assert done.wait(30)


def nodes(of: RecordedParameters) -> tuple[str, ...]:
    return asyncio.run(of.nodes(GetParameterNodes(request=1))).nodes


def values(of: RecordedParameters, node: str) -> dict[str, int]:
    asked = asyncio.run(of.parameters(GetParameters(request=1, node=node)))
    return {one.name: int(one.value) for one in asked.parameters}


AT_MOMENTS: dict[float, tuple[tuple[str, ...], dict[str, int]]] = {
    0.5: ((), {}),
    1.5: (("/arm",), {"speed": 1, "gain": 5}),
    2.5: (("/arm",), {"speed": 2, "gain": 5, "limit": 9}),
    3.5: (("/arm", "/base"), {"speed": 2, "limit": 9}),
}


def check(of: RecordedParameters, at_s: float) -> None:
    names, arm = AT_MOMENTS[at_s]
    assert nodes(of) == names
    if arm:
        assert values(of, "/arm") == arm
    else:
        with pytest.raises(CommandError, match=r"No change of a parameter of /arm is recorded"):
            values(of, "/arm")


def test_parameters_are_as_they_were_at_each_moment_forwards_and_backwards():
    with source(recording()) as opened:
        of = RecordedParameters(opened)
        for at_s in (*AT_MOMENTS, *reversed(AT_MOMENTS), 3.5, 1.5):
            go_to(opened, at_s)
            check(of, at_s)


def test_a_second_request_for_a_moment_reads_nothing_and_a_later_one_only_what_came_since():
    made = recording()
    with source(made) as opened:
        of = RecordedParameters(opened)
        reads = list[int]()
        for at_s in (2.5, 2.5, 3.5, 3.5, 1.5):
            go_to(opened, at_s)
            check(of, at_s)
            reads.append(made.reads.get(EVENTS, 0))
    assert reads == [2, 2, 4, 4, 5]


def test_the_state_is_of_the_last_5000_events_where_more_came_than_are_read():
    made = recording()
    for number in range(5_000):
        made.say(
            EVENTS,
            BEGIN + 5 * S + number,
            node="/counter",
            changed_parameters=[parameter("count", number)],
        )
    with source(made) as opened:
        of = RecordedParameters(opened)
        go_to(opened, 3.5)
        check(of, 3.5)
        go_to(opened, 6.0)
        assert nodes(of) == ("/counter",)
        assert values(of, "counter") == {"count": 4_999}
