"""The course's rows on services: SV1-SV3, each node in a process of its own."""

from __future__ import annotations

import signal
from typing import Any

import pytest

from studio.ros.client import service
from tests.support.demos import call, node_at, running_demo

pytestmark = pytest.mark.network
GET_NOW_PLAYING = "radio_station_interfaces/srv/GetNowPlaying"
LINES_MAX = 100
"""A client that waits says so once a second; one that no longer does says it without end."""


def test_sv1_the_radio_station_answers_with_three_strings(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "service_server") as station:
        answer = call(node, GET_NOW_PLAYING, "/get_now_playing")
        assert answer.station_name == "Radio Educativa 100.3 FM"
        assert (answer.song_title, answer.artist_name) == ("Bohemian Rhapsody", "Queen")
        station.wait_for("Returned current track info.")


def test_sv1_the_listener_waits_for_the_station_logs_what_plays_and_ends(endpoint: str):
    with running_demo(endpoint, "service_client") as listener:
        listener.wait_for("Waiting for now playing service...")
        with running_demo(endpoint, "service_server"):
            assert listener.wait() == 0
    assert "Song: Bohemian Rhapsody\nArtist: Queen\n" in listener.printed


@pytest.mark.parametrize("package", ["learning_interface", "example_interfaces"])
def test_sv2_41_and_1_are_42(endpoint: str, package: str):
    server = {"learning_interface": "adder_server", "example_interfaces": "service_server_node"}
    with node_at(endpoint) as node, running_demo(endpoint, server[package]):
        assert call(node, f"{package}/srv/AddTwoInts", "/add_two_ints", a=41, b=1).sum == 42


def test_sv2_the_adders_client_waits_for_a_late_server(endpoint: str):
    with running_demo(endpoint, "adder_client", "41", "1") as client:
        client.wait_for("service not available, waiting again...")
        with running_demo(endpoint, "adder_server") as server:
            assert client.wait() == 0
            server.wait_for("Incoming request\na: 41 b: 1")
    assert "Result of add_two_ints: for 41 + 1 = 42" in client.printed


def test_sv2_the_service_client_spins_until_its_answer_is_there(endpoint: str):
    with (
        running_demo(endpoint, "service_server_node"),
        running_demo(endpoint, "service_client_node", "20", "-22") as client,
    ):
        assert client.wait() == 0
    assert "Result of 20 + -22 = -2" in client.printed


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_sv2_a_client_that_waits_for_a_server_ends_when_told_to(endpoint: str, number: int):
    with running_demo(endpoint, "adder_client", "41", "1") as client:
        client.wait_for("service not available, waiting again...")
        client.stop(number)
    assert "Traceback" not in client.printed
    assert client.printed.count("waiting again") < LINES_MAX


def test_sv3_points_are_added_and_the_answer_of_a_server_that_sleeps_or_ends_is_given_up(
    endpoint: str,
):
    with node_at(endpoint) as node, running_demo(endpoint, "add_points_server") as server:
        points: dict[str, Any] = {}
        request = service("pkg_with_interfaces/srv/AddPoints").Request()
        for name, place in (("a", (1.0, 2.0, 3.0)), ("b", (0.5, -2.0, 4.0))):
            point = getattr(request, name)
            point.x, point.y, point.z = place
            points[name] = point
        result = call(node, "pkg_with_interfaces/srv/AddPoints", "/add_points", **points).result
        assert (result.x, result.y, result.z) == (1.5, 0.0, 7.0)
        with running_demo(endpoint, "add_points_client") as client:
            client.wait_for("The result was")
            server.process.send_signal(signal.SIGSTOP)
            client.wait_for("The answer took too long: it was given up.")
            server.process.send_signal(signal.SIGCONT)
            before = client.printed.count("The result was")
            client.wait_for_more("The result was", before)
            server.stop()
            before = client.printed.count("The response was None.")
            client.wait_for_more("The response was None.", before + 1)
            assert client.process.poll() is None
