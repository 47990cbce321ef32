"""The router: away, no Zenoh, or closed to strangers."""

from __future__ import annotations

import contextlib
import socket
import threading
from typing import TYPE_CHECKING

import pytest

from studio.live.connection.report import examine as examine_place
from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Seen
from studio.settings import WireChoice
from tests.support.patient import Patient, patient_system
from tests.support.wire import free_endpoint, router_at

if TYPE_CHECKING:
    from studio.protocol.connection import Verdict

pytestmark = pytest.mark.network


def found_at(endpoint: str, router: str = "off") -> dict[str, str]:
    """Levels of what is found at a place, by code."""
    place = examine_place(WireChoice(router, (endpoint,), 0, "jazzy"), ())
    return {one.code: one.level for one in examine(Seen(place=place)).findings}


def answer_as_a_web_server(listener: socket.socket) -> None:
    """Hang up on everybody with a few words, until the listener is closed."""
    with contextlib.suppress(OSError):
        while True:
            link, _ = listener.accept()
            with link:
                link.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")


def test_no_router_is_an_error_unless_one_would_be_started():
    nowhere = free_endpoint()
    assert found_at(nowhere)["no-router"] == "error"
    assert found_at(nowhere, "auto")["no-router"] == "warn"


def test_another_program_at_its_address_is_an_error():
    with socket.create_server(("127.0.0.1", 0)) as other:
        answering = threading.Thread(target=answer_as_a_web_server, args=(other,))
        answering.start()
        port = other.getsockname()[1]
        found = found_at(f"tcp/127.0.0.1:{port}")
        other.shutdown(socket.SHUT_RDWR)  # which ends `accept`
    answering.join()
    assert found["no-zenoh"] == "error"


@pytest.mark.parametrize(
    ("verdict", "code", "level"),
    [("not_admitted", "not-admitted", "error"), ("bridge", "only-a-bridge", "warn")],
)
def test_a_router_without_use_for_the_studio_is_found(verdict: Verdict, code: str, level: str):
    nowhere = examine_place(WireChoice("off", (free_endpoint(),), 0, "jazzy"), ())
    place = nowhere.model_copy(update={"verdict": verdict})
    found = {one.code: one for one in examine(Seen(place=place)).findings}[code]
    assert found.level == level
    assert found.evidence[0].startswith(f"{place.endpoint}: ")


def test_a_router_that_is_there_and_not_joined_can_be_joined(patient: Patient):
    place = examine_place(WireChoice("off", (patient.endpoint,), 0, "jazzy"), ())
    found = {one.code: one for one in examine(Seen(place=place)).findings}["not-connected"]
    assert found.mend is not None
    assert found.mend.command == {"type": "connect_wire"}


def test_a_router_that_went_away_is_an_error():
    endpoint = free_endpoint()
    router = router_at(endpoint)
    try:
        with patient_system(endpoint) as made:
            assert "router-gone" not in made.codes("")
            router.close()
            found = made.until("router-gone")
            assert found.level == "error"
            assert endpoint in found.sentence
    finally:
        router.close()


def test_a_router_that_is_there_is_said_with_its_version(patient: Patient):
    (router,) = (one for one in patient.examined(asks=True).subjects if one.subject == "router")
    assert router.state == "well"
    assert router.detail.startswith(f"{patient.endpoint}, Zenoh 1.")
