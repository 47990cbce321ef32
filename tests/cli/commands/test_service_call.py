from __future__ import annotations

import signal
import threading
from typing import TYPE_CHECKING

import pytest

from studio.ros.messages import service
from tests.support.command_line import comes_to, started, studio
from tests.support.demos import node_at, running_demo
from tests.support.wire import PATIENCE_S, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

KIND = "learning_interface/srv/AddTwoInts"


@pytest.fixture(scope="module", autouse=True)
def adder(endpoint: str) -> Generator[None]:
    with running_demo(endpoint, "adder_server"):
        wait_until(
            "the server",
            lambda: "/add_two_ints" in studio("service", "list", "--connect", endpoint).out,
        )
        yield


def test_sv2_a_call_answers_42(endpoint: str):
    ran = studio("service", "call", "/add_two_ints", KIND, "{a: 41, b: 1}", "--connect", endpoint)
    assert ran.code == 0
    assert ran.out == (
        "requester: making request: learning_interface.srv.AddTwoInts_Request(a=41, b=1)\n\n"
        "response:\nlearning_interface.srv.AddTwoInts_Response(sum=42)\n\n"
    )


def test_sv2_list_info_type_and_find(endpoint: str):
    at = ("--connect", endpoint)
    assert f"/add_two_ints [{KIND}]\n" in studio("service", "list", "-t", *at).out
    told = f"Type: {KIND}\nClients count: 0\nServices count: 1\n"
    comes_to(lambda ran: ran.out == told, "service", "info", "/add_two_ints", *at)
    assert studio("service", "type", "/add_two_ints", *at).out == f"{KIND}\n"
    assert studio("service", "find", KIND, *at).out == "/add_two_ints\n"
    assert studio("service", "find", KIND, "-c", *at).out == "1\n"
    assert studio("service", "type", "/nope", *at).code == 1
    assert studio("service", "info", "/nope", *at).err == "Unknown service '/nope'\n"


def test_calls_are_repeated_at_a_rate(endpoint: str):
    words = ("service", "call", "/add_two_ints", KIND, "{a: 1, b: 2}", "-r", "50")
    with started(endpoint, *words, "--connect", endpoint) as call:
        wait_until("three", lambda: call.printed.count("AddTwoInts_Response(sum=3)") >= 3)
        assert call.stop(signal.SIGINT) == 2


def test_a_service_that_nobody_serves_is_waited_for(endpoint: str):
    at = ("--connect", endpoint)
    ran = studio("service", "call", "/nope", KIND, "--timeout", "0.2", *at)
    assert ran.code == 1
    assert ran.out == "waiting for service to become available...\n"
    with started(endpoint, "service", "call", "/nope", KIND, *at) as call:
        call.wait_for("waiting for service")
        assert call.stop(signal.SIGINT) == 2  # which waits for two seconds


def test_another_type_than_the_service_has_is_said(endpoint: str):
    words = ("service", "call", "/add_two_ints", "std_srvs/srv/Empty", "--timeout", "0.2")
    ran = studio(*words, "--connect", endpoint)
    assert ran.code == 1
    assert ran.err.startswith(
        f"WARNING: /add_two_ints has the type {KIND}, not std_srvs/srv/Empty\n"
    )


def test_sv3_a_service_that_never_answers_is_given_up(endpoint: str):
    at = ("--connect", endpoint)
    with node_at(endpoint, "slow") as node:
        given_up = threading.Event()

        def answer(_request: object, response: object) -> object:
            given_up.wait(PATIENCE_S)
            return response

        node.create_service(service(KIND), "/slow", answer)
        ran = studio("service", "call", "/slow", KIND, "--timeout", "0.3", *at)
        given_up.set()
    assert ran.code == 1
    assert "/slow did not answer within 0.3 s." in ran.err


@pytest.mark.parametrize("values", ["{a: x}", "{c: 1}", "[", "{a: 99999999999999999999}"])
def test_a_wrong_request_is_one_sentence(endpoint: str, values: str):
    ran = studio("service", "call", "/add_two_ints", KIND, values, "--connect", endpoint)
    assert ran.code == 2
    assert ran.err.startswith("studio: ")
