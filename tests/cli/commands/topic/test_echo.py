from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import started, studio
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

STATE = "{header: {frame_id: base}, name: [a, b], position: [1.0, -2.5]}"


@pytest.fixture(scope="module", autouse=True)
def talkers(endpoint: str) -> Generator[None]:
    joints = ("topic", "pub", "/joints", "sensor_msgs/msg/JointState", STATE, "-r", "20")
    latched = ("topic", "pub", "/latched", "std_msgs/msg/String", "data: kept", "-r", "0.001",
               "--qos-durability", "transient_local")  # fmt: skip
    with started(endpoint, *joints) as one, started(endpoint, *latched) as other:
        one.wait_for("publishing #1")
        other.wait_for("publishing #1")
        yield


def test_t1_echo_equals_what_is_published(endpoint: str):
    ran = studio("topic", "echo", "/joints", "--once", "--connect", endpoint)
    assert ran.code == 0
    assert ran.out == (
        "header:\n  stamp:\n    sec: 0\n    nanosec: 0\n  frame_id: base\n"
        "name:\n- a\n- b\nposition:\n- 1.0\n- -2.5\nvelocity: []\neffort: []\n---\n"
    )


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--field", "position[1]"), "-2.5\n---\n"),
        (("--field", "header.frame_id"), "base\n---\n"),
        (("--csv",), "0,0,base,a,b,1.0,-2.5\n"),
        (("--csv", "--field", "position"), "1.0,-2.5\n"),
        (("--no-arr", "--field", "position"), "<sequence, length: 2>\n---\n"),
        (("-l", "1", "--field", "name"), "['a', '...']\n---\n"),
    ],
)
def test_t1_what_is_shown_can_be_chosen(endpoint: str, options: tuple[str, ...], said: str):
    out = studio("topic", "echo", "/joints", "--once", *options, "--connect", endpoint).out
    assert out == said.replace("'...'", "...")


def test_t1_only_messages_of_which_a_filter_holds_are_shown(endpoint: str):
    at = ("--connect", endpoint)
    ran = studio("topic", "echo", "/joints", "--once", "--filter", "'b' in m.name", *at)
    assert "- -2.5\n" in ran.out
    words = ("topic", "echo", "/joints", "--timeout")
    assert studio(*words, "0.5", "--filter", "m.position[1] > 0", *at).out == ""
    for options, said in (
        (("--filter", "m.no_such"), "no attribute 'no_such'"),
        (("--filter", "import os"), "is no expression"),
        (("--filter", "m.name", "--raw"), "give one"),
    ):
        ran = studio(*words, "60", *options, *at)
        assert ran.code == 2
        assert said in ran.err


def test_arrays_are_abbreviated_in_whole_messages(endpoint: str):
    out = studio("topic", "echo", "/joints", "--once", "--no-arr", "--connect", endpoint).out
    assert "position: '<sequence type: double, length: 2>'" in out


def test_t4_a_late_joiner_gets_what_is_latched(endpoint: str):
    ran = studio("topic", "echo", "/latched", "--once", "--timeout", "10", "--connect", endpoint)
    assert ran.out == "data: kept\n---\n"


def test_t8_the_type_may_be_given_before_anybody_publishes(endpoint: str):
    words = ("topic", "echo", "/later", "std_msgs/msg/String", "--connect", endpoint)
    with started(endpoint, *words) as echo:
        wait_until(
            "the subscription",
            lambda: "/later" in studio("topic", "list", "--connect", endpoint).out.split(),
        )
        studio("topic", "pub", "-1", "/later", "std_msgs/msg/String", "data: hi", "--connect",
               endpoint)  # fmt: skip
        echo.wait_for("data: hi\n---\n")
        assert "does not appear to be published yet" in echo.printed
        assert echo.stop(signal.SIGINT) == 2


def test_a_topic_without_a_type_ends_with_1(endpoint: str):
    ran = studio("topic", "echo", "/nope", "--connect", endpoint)
    assert ran.code == 1
    assert "Could not determine the type" in ran.err


@pytest.mark.parametrize("field", ["no", "position[9]", "name.x"])
def test_a_field_that_is_not_there_is_one_sentence(endpoint: str, field: str):
    ran = studio("topic", "echo", "/joints", "--field", field, "--connect", endpoint)
    assert ran.code == 2
    assert ran.err.startswith("studio: ")


def test_another_type_than_the_topic_has_is_said(endpoint: str):
    ran = studio("topic", "echo", "/latched", "std_msgs/msg/Int64", "--timeout", "0.1", "--connect",
                 endpoint)  # fmt: skip
    assert (ran.code, ran.out) == (1, "")
    assert ran.err == "WARNING: /latched has the type std_msgs/msg/String, not std_msgs/msg/Int64\n"


def test_nothing_within_the_time_ends_with_1(endpoint: str):
    ran = studio("topic", "echo", "/silent", "std_msgs/msg/String", "--timeout", "0.2",
                 "--connect", endpoint)  # fmt: skip
    assert (ran.code, ran.out) == (1, "")


def test_t11_a_type_that_only_the_publisher_knows_is_asked_of_it(endpoint: str, tmp_path: Path):
    folder = tmp_path / "own_interfaces" / "msg"
    folder.mkdir(parents=True)
    (folder / "Telemetry.msg").write_text("float32 voltage\ngeometry_msgs/Point[] path\n")
    words = ("topic", "pub", "/telemetry", "own_interfaces/msg/Telemetry",
             "{voltage: 2.5, path: [{x: -1.0}]}", "-r", "10", "--interfaces", str(folder.parent),
             "--connect", endpoint)  # fmt: skip
    with started(endpoint, *words) as pub:
        pub.wait_for("publishing #1")
        ran = studio("topic", "echo", "/telemetry", "--once", "--connect", endpoint)
    assert ran.code == 0, ran.err
    assert ran.out == "voltage: 2.5\npath:\n- x: -1.0\n  y: 0.0\n  z: 0.0\n---\n"


def test_q1_another_form_of_a_type_is_said_not_waited_for_in_silence(endpoint: str, tmp_path: Path):
    folder = tmp_path / "std_msgs" / "msg"
    folder.mkdir(parents=True)
    (folder / "String.msg").write_text("string data\nstring more\n")
    ran = studio("topic", "echo", "/latched", "--timeout", "0.2", "--interfaces",
                 str(folder.parent), "--connect", endpoint)  # fmt: skip
    assert ran.code == 1
    assert ran.err.startswith("WARNING: Others have std_msgs/msg/String as of ")
