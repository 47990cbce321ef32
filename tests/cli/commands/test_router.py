from __future__ import annotations

import signal

import pytest

from tests.support.command_line import started, studio
from tests.support.wire import free_endpoint


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_router_runs_alone_until_it_is_told_to_end(number: int):
    endpoint = free_endpoint()
    with started(endpoint, "router", "--listen", endpoint) as router:
        router.wait_for(f"Zenoh router at {endpoint}; Ctrl-C ends it.")
        ran = studio("topic", "list", "--connect", endpoint)
        assert (ran.code, ran.out) == (0, "")
        taken = studio("router", "--listen", endpoint)
        assert taken.code == 2
        assert taken.err.count("\n") == 1
        assert router.stop(number) == 0


@pytest.mark.parametrize("endpoint", ["nonsense", "tcp/127.0.0.1", "tcp/127.0.0.1:99999"])
def test_what_is_no_endpoint_is_one_sentence(endpoint: str):
    for words in (("router", "--listen", endpoint), ("topic", "list", "--connect", endpoint)):
        ran = studio(*words)
        assert ran.code == 2
        assert ran.err.startswith("studio: ")
        assert ran.err.count("\n") == 1


def test_to_join_takes_a_line_that_names_a_router():
    ran = studio("router", "--listen", free_endpoint(), "--join")
    assert ran.code == 2
    assert ran.err == (
        "studio: ZENOH_CONFIG_OVERRIDE names no router to join: "
        "paste the line of the class first.\n"
    )
