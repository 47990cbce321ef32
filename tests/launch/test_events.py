from __future__ import annotations

import msgspec
import pytest

from studio.launch.events import (
    Ended,
    EndProcess,
    ProcessStarted,
    line_of,
    read_command,
    read_event,
)


def test_an_event_is_a_line_that_reads_back():
    event = ProcessStarted(3, "talker-1", "/talker", 42, ("python", "-m", "x"))
    line = line_of(event)
    assert line.endswith(b"\n")
    assert b'"event":"process_started"' in line
    assert read_event(line) == event
    assert read_event(b'{"event":"ended","code":0}') == Ended(0)


def test_commands_are_told_from_what_is_none():
    assert read_command(b'{"command":"end_process","id":2}') == EndProcess(2)
    with pytest.raises(msgspec.DecodeError):
        read_command(b'{"command":"rm"}')
