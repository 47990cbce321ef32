"""Errors and warnings of a recording: of the log, and of parts that become worse or better."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import pytest

from studio.errors import BagError
from studio.live.time.ticks import TICKS_MAX, RecordingTicks, Tick
from studio.ros.cdr import codec_of
from studio.ros.messages import message
from studio.ros.node.samples import RawSample
from tests.live.time.test_past import a_past, opened
from tests.live.time.test_past import sample as past_sample
from tests.support.memory_recording import MemoryRecording

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.bags.recording import Recorded

S = 1_000_000_000
BEGIN = 1_700_000_000 * S
LOG, DIAGNOSTICS = "rcl_interfaces/msg/Log", "diagnostic_msgs/msg/DiagnosticArray"


def recording() -> MemoryRecording:
    made = MemoryRecording()
    made.add_topic("/rosout", LOG)
    made.add_topic("/diagnostics", DIAGNOSTICS)
    return made


def log(made: MemoryRecording, at_s: float, level: int, text: str) -> None:
    made.say("/rosout", BEGIN + round(at_s * S), level=level, name="driver", msg=text)


def states(*parts: tuple[str, int]) -> dict[str, Any]:
    """A message of diagnostics: parts and their levels."""
    kind = message("diagnostic_msgs/msg/DiagnosticStatus")
    return {
        "status": [kind(name=name, level=level, message=f"{name} {level}") for name, level in parts]
    }


def told(ticks: RecordingTicks) -> list[tuple[float, str, str]]:
    return [((one.at_ns - BEGIN) / S, one.level, one.text) for one in ticks.read()[0]]


def test_the_log_ticks_where_it_warns_and_where_something_fails():
    made = recording()
    for at, level in enumerate((10, 20, 30, 40, 50)):
        log(made, at, level, f"level {level}")
    expected = [(2.0, "warn", "level 30"), (3.0, "error", "level 40"), (4.0, "error", "level 50")]
    ticks = RecordingTicks(made)
    assert told(ticks) == expected
    assert ticks.read()[1:] == (0, 1.0)


def test_a_part_ticks_when_it_becomes_worse_or_better_but_not_well_and_not_again_and_again():
    made = recording()
    for at, level in enumerate((0, 1, 1, 1, 2, 2, 1, 0, 0, 3, 3)):
        made.say("/diagnostics", BEGIN + at * S, **states(("motor", level), ("fan", 0)))
    assert told(RecordingTicks(made)) == [
        (1.0, "warn", "motor 1"),
        (4.0, "error", "motor 2"),
        (6.0, "warn", "motor 1"),
        (9.0, "error", "motor 3"),
    ]


def test_what_was_latched_before_it_was_recorded_ticks_when_it_was_sent():
    made = recording()
    log(made, 0, 20, "begins")
    line = message(LOG)(level=40, name="driver", msg="early")
    payload = bytes(codec_of(message(LOG)).encode(line))
    kept = made.last("/rosout", BEGIN, 1)[0]
    late = RawSample(payload, kept.attachment._replace(source_time_ns=BEGIN + S), BEGIN + 60 * S)
    made.put("/rosout", late)
    assert told(RecordingTicks(made)) == [(1.0, "error", "early")]


def test_of_too_many_the_errors_stay_and_it_is_told_how_many_are_left_out():
    made = recording()
    for at in range(3 * TICKS_MAX):
        log(made, at, 40 if at % 100 == 0 else 30, str(at))
    ticks = RecordingTicks(made)
    found, more, done = ticks.read()
    while done < 1:
        found, more, done = ticks.read()
    errors = [one for one in found if one.level == "error"]
    assert len(errors) == 3 * TICKS_MAX // 100
    assert len(found) <= TICKS_MAX
    assert len(found) + more == 3 * TICKS_MAX


def test_what_is_no_log_has_no_ticks():
    made = MemoryRecording()
    made.add_topic("/rosout", "std_msgs/msg/String")
    made.say("/rosout", BEGIN, data="error")
    made.add_topic("/diagnostics", DIAGNOSTICS)
    made.add("/diagnostics", BEGIN + S, b"\x00\x01\x00\x00rubbish")
    made.say("/diagnostics", BEGIN + 2 * S, **states(("motor", 2)))
    assert told(RecordingTicks(made)) == [(2.0, "error", "motor 2")]


class Broken(MemoryRecording):
    """A file that cannot be read for a while; and how often reading began."""

    def __init__(self) -> None:
        super().__init__()
        self.is_broken, self.begun = True, 0
        self.gate = threading.Event()
        self.gate.set()

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        self.begun += 1
        self.gate.wait(60)
        if self.is_broken:
            raise BagError("The disk is gone.")
        return super().messages(topics, begin_ns, end_ns)


def test_a_file_that_cannot_be_read_is_said_and_read_again_later():
    made = Broken()
    made.add_topic("/rosout", LOG)
    log(made, 1, 40, "stop")
    ticks = RecordingTicks(made)
    with pytest.raises(BagError):
        ticks.read()
    made.is_broken = False
    assert told(ticks) == [(1.0, "error", "stop")]
    ticks.read()
    assert made.begun == 2  # what was read is not read again


class Torn(MemoryRecording):
    """A file that cannot be read beyond its first message."""

    def messages(self, topics: Iterable[str], begin_ns: int, end_ns: int) -> Iterator[Recorded]:
        for number, one in enumerate(super().messages(topics, begin_ns, end_ns)):
            if number or begin_ns > BEGIN:
                raise BagError("The disk is gone.")
            yield one


def test_a_file_that_fails_in_its_midst_is_never_said_to_be_read():
    made = Torn()
    made.add_topic("/rosout", LOG)
    log(made, 1, 40, "stop")
    log(made, 2, 40, "stop again")
    ticks = RecordingTicks(made)
    for _ in range(2):
        with pytest.raises(BagError):
            ticks.read()


def test_who_asks_while_another_reads_is_answered_at_once():
    made = Broken()
    made.add_topic("/rosout", LOG)
    log(made, 1, 40, "stop")
    made.is_broken = False
    made.gate.clear()
    ticks = RecordingTicks(made)
    found: list[tuple[tuple[Tick, ...], int, float]] = []
    reading = threading.Thread(target=lambda: found.append(ticks.read()))
    reading.start()
    while not made.begun:
        pass
    assert ticks.read() == ((), 0, 0.0)
    made.gate.set()
    reading.join()
    assert [one.text for one in found[0][0]] == ["stop"]


def test_of_a_past_that_grows_only_what_came_since_is_read_and_what_is_gone_is_dropped():
    past = a_past(1 << 20)
    lines, others = opened(past, "/rosout", type_name=LOG), opened(past, "/a")

    def say(at_s: int, text: str) -> None:
        line = message(LOG)(level=40, name="driver", msg=text)
        payload = bytes(codec_of(message(LOG)).encode(line))
        lines.put([past_sample(BEGIN + at_s * S, payload, number=at_s + 1)])

    ticks = RecordingTicks(past)
    say(1, "one")
    assert told(ticks) == [(1.0, "error", "one")]
    say(12, "two")
    say(30, "three")
    assert [one for _, _, one in told(ticks)] == ["one", "two", "three"]
    others.put([past_sample(BEGIN + 29 * S + at, bytes(10_000)) for at in range(50)])
    others.put([past_sample(BEGIN + 400 * S + at, bytes(10_000)) for at in range(60)])
    past.collect()
    assert past.begin_ns > BEGIN + 15 * S
    assert [one for one, _, _ in told(ticks)] == [30.0]
