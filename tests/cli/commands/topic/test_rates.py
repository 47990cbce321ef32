from __future__ import annotations

import re
import signal
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import started, studio
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator


@pytest.fixture(scope="module", autouse=True)
def source(endpoint: str) -> Generator[None]:
    words = ("topic", "pub", "/steady", "geometry_msgs/msg/PointStamped", "header: auto",
             "-r", "30", "-p", "1000000")  # fmt: skip
    with started(endpoint, *words) as process:
        process.wait_for("beginning loop")
        yield


def rates(printed: str) -> list[float]:
    return [float(rate) for rate in re.findall(r"average rate: ([\d.]+)", printed)]


def delays(printed: str) -> list[float]:
    return [float(delay) for delay in re.findall(r"average delay: ([\d.]+)", printed)]


def test_t3_a_source_of_30_hz_reads_29_to_31(endpoint: str):
    # Over a short time: one long pause of a busy machine would stay in the mean of all.
    with started(endpoint, "topic", "hz", "-w", "60", "/steady", "--connect", endpoint) as hz:
        wait_until("30 Hz", lambda: any(29 <= rate <= 31 for rate in rates(hz.printed)))
        assert hz.stop(signal.SIGINT) == 2


def test_t3_bytes_and_delays_are_measured(endpoint: str):
    with (
        started(endpoint, "topic", "bw", "/steady", "--connect", endpoint) as bw,
        started(endpoint, "topic", "delay", "/steady", "--connect", endpoint) as delay,
    ):
        bw.wait_for("Message size mean:")
        assert re.search(r"(\d\.\d+ KB|\d+ B)/s from \d+ messages\n\tMessage size mean", bw.printed)
        delay.wait_for("average delay:")
        wait_until("one below a second", lambda: any(0 <= s < 1 for s in delays(delay.printed)))
        assert delay.stop(signal.SIGTERM) == 143


def test_t3_several_topics_are_measured_and_one_that_is_not_there_yet_is_waited_for(endpoint: str):
    words = ("topic", "hz", "/steady", "/later", "--filter", "m.point.x < 1", "--connect", endpoint)
    later = ("topic", "pub", "/later", "geometry_msgs/msg/PointStamped", "{}", "-r", "50", "-p",
             "1000000")  # fmt: skip
    with started(endpoint, *words) as hz:
        hz.wait_for("WARNING: topic [/later] does not appear to be published yet\n")
        hz.wait_for("\n/steady   ")
        with started(endpoint, *later):
            hz.wait_for("\n/later    ")
        assert hz.stop(signal.SIGINT) == 2


def test_a_topic_of_several_types_ends_with_1(endpoint: str):
    with (
        started(endpoint, "topic", "pub", "/both", "std_msgs/msg/String") as one,
        started(endpoint, "topic", "pub", "/both", "std_msgs/msg/Int64") as other,
    ):
        one.wait_for("publishing #1")
        other.wait_for("publishing #1")
        ran = studio("topic", "bw", "/both", "--connect", endpoint)
    assert (ran.code, ran.out) == (1, "")
    assert ran.err.startswith("Cannot tell the type of topic '/both', it has several: ")


def test_a_window_of_nothing_is_refused():
    assert studio("topic", "hz", "/x", "-w", "0").code == 2
