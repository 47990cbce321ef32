from __future__ import annotations

import re
from typing import Any

import pytest

from studio.ros.node.clock import Clock, ClockType
from studio.ros.node.log_lines import line_of
from studio.ros.node.logger import Entry, LoggingSeverity, get_logger, listen_to


def test_a_line_is_written_as_rclpy_does(capsys: pytest.CaptureFixture[str]):
    get_logger("line_writer").info("hello")
    written = capsys.readouterr()
    assert re.fullmatch(r"\[INFO\] \[\d+\.\d{9}\] \[line_writer\]: hello\n", written.err)
    assert written.out == ""


def test_seconds_and_nanoseconds_are_told_apart():
    entry = Entry(LoggingSeverity.WARN, 12_000_000_034, "a.b", "text", "f", "g", 1)
    assert line_of(entry) == "[WARN] [12.000000034] [a.b]: text"


@pytest.mark.parametrize(
    ("level", "said"),
    [
        (LoggingSeverity.DEBUG, ["DEBUG", "INFO", "WARN", "WARN", "ERROR", "FATAL"]),
        (LoggingSeverity.INFO, ["INFO", "WARN", "WARN", "ERROR", "FATAL"]),
        (LoggingSeverity.FATAL, ["FATAL"]),
    ],
)
def test_what_is_less_grave_than_the_level_is_not_said(
    level: LoggingSeverity, said: list[str], capsys: pytest.CaptureFixture[str]
):
    logger = get_logger("levels")
    logger.set_level(level)
    for say in (logger.debug, logger.info, logger.warn, logger.warning, logger.error, logger.fatal):
        say("x")
    assert re.findall(r"^\[(\w+)\]", capsys.readouterr().err, re.MULTILINE) == said
    logger.set_level(LoggingSeverity.UNSET)


def test_a_child_takes_the_level_of_its_parent_until_it_has_one():
    parent, child = get_logger("family"), get_logger("family").get_child("child")
    parent.set_level(LoggingSeverity.ERROR)
    assert child.name == "family.child"
    assert child.get_effective_level() is LoggingSeverity.ERROR
    child.set_level(LoggingSeverity.DEBUG)
    assert child.is_enabled_for(LoggingSeverity.DEBUG)
    assert not parent.is_enabled_for(LoggingSeverity.WARN)
    parent.set_level(LoggingSeverity.UNSET)


def test_once_says_it_once(capsys: pytest.CaptureFixture[str]):
    said = [get_logger("once").info("x", once=True) for _ in range(3)]
    assert said == [True, False, False]
    assert capsys.readouterr().err.count("\n") == 1


def test_skipping_the_first_says_the_others():
    assert [get_logger("skip").info("x", skip_first=True) for _ in range(3)] == [False, True, True]


def test_once_after_the_first_says_the_second_only():
    logger = get_logger("skip_once")
    said = [logger.info("x", once=True, skip_first=True) for _ in range(4)]
    assert said == [False, True, False, False]


def test_throttling_says_it_once_in_the_span():
    logger = get_logger("throttle")
    assert [logger.info("x", throttle_duration_sec=3_600.0) for _ in range(3)] == [
        True,
        False,
        False,
    ]


def test_two_places_in_the_code_are_throttled_each_for_itself():
    logger = get_logger("places")
    assert logger.info("x", once=True)
    assert logger.info("x", once=True)
    assert [(logger.info("x", once=True), logger.info("y", once=True)) for _ in range(2)] == [
        (True, True),
        (False, False),
    ]


def test_a_first_one_that_is_skipped_counts_for_throttling():
    logger = get_logger("skip_throttle")
    assert not any(
        logger.info("x", skip_first=True, throttle_duration_sec=3_600.0) for _ in range(3)
    )


def test_throttling_goes_by_the_clock_that_is_given():
    clock = Clock(clock_type=ClockType.ROS_TIME)
    said: list[bool] = []
    for now_ms in (500, 1_000, 1_500, 2_000):
        clock.set_ros_time(now_ms * 1_000_000)
        said.append(
            get_logger("by_clock").info(
                "x", throttle_duration_sec=1.0, throttle_time_source_type=clock
            )
        )
    assert said == [False, True, False, True]


@pytest.mark.parametrize(
    "asked",
    [
        ({"once": True}, {"skip_first": True}),
        ({"throttle_duration_sec": 1.0}, {"throttle_duration_sec": 2.0}),
        ({"once": True, "name": "a"}, {"once": True, "name": "b"}),
    ],
)
def test_a_place_that_asks_for_something_else_is_refused(asked: tuple[dict[str, Any], ...]):
    logger = get_logger(f"changing {asked}")

    def say() -> None:
        for one in asked:
            logger.info("x", **one)

    with pytest.raises(ValueError, match="cannot be changed between calls"):
        say()


def test_a_place_that_changes_the_severity_is_refused():
    logger = get_logger("changing severity")

    def say() -> None:
        for severity in (LoggingSeverity.INFO, LoggingSeverity.WARN):
            logger.log("x", severity, once=True)

    with pytest.raises(ValueError, match="severity cannot be changed"):
        say()


def test_limits_that_are_none_are_refused():
    logger = get_logger("refused")
    with pytest.raises(TypeError, match="nonsense"):
        logger.info("x", nonsense=True)
    with pytest.raises(TypeError, match="needs throttle_duration_sec"):
        logger.info("x", throttle_time_source_type=Clock())
    with pytest.raises(ValueError, match="takes a clock"):
        logger.info("x", throttle_duration_sec=1.0, throttle_time_source_type="steady")
    with pytest.raises(ValueError, match="needs a name"):
        logger.get_child("")


def test_listeners_are_told_what_a_logger_and_its_children_say():
    heard: list[Entry] = []
    stop = listen_to("heard", heard.append)
    get_logger("heard").info("one")
    get_logger("heard.child").error("two")
    get_logger("unheard").info("three")
    stop()
    stop()
    get_logger("heard").info("four")
    assert [(entry.name, entry.text) for entry in heard] == [
        ("heard", "one"),
        ("heard.child", "two"),
    ]
    assert heard[0].file == __file__
    assert heard[0].function == test_listeners_are_told_what_a_logger_and_its_children_say.__name__
