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


def test_t3_a_source_of_30_hz_reads_29_to_31(endpoint: str):
    with started(endpoint, "topic", "hz", "/steady", "--connect", endpoint) as hz:
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
        found = re.search(r"average delay: ([\d.]+)", delay.printed)
        assert found is not None
        assert 0 <= float(found[1]) < 1
        assert delay.stop(signal.SIGTERM) == 143


@pytest.mark.parametrize("verb", ["hz", "bw", "delay"])
def test_a_topic_without_a_type_ends_with_1(endpoint: str, verb: str):
    assert studio("topic", verb, "/nope", "--connect", endpoint).code == 1


def test_a_window_of_nothing_is_refused():
    assert studio("topic", "hz", "/x", "-w", "0").code == 2
