from __future__ import annotations

import socket

import pytest

from studio.errors import PortTakenError, SettingsError
from studio.server import ports
from studio.server.ports import bind, lan_addresses, page_address, port_of
from studio.settings import DEFAULT_PORT


def test_a_port_that_is_asked_for_is_taken_or_an_error():
    with bind("127.0.0.1", 0) as held:
        port = port_of(held)
        with pytest.raises(PortTakenError) as taken:
            bind("127.0.0.1", port)
    assert str(taken.value).startswith(f"Port {port} on 127.0.0.1 is taken")
    with bind("127.0.0.1", port) as free_again:
        assert port_of(free_again) == port


def test_without_a_port_the_next_free_one_is_found(monkeypatch: pytest.MonkeyPatch):
    with bind("127.0.0.1", 0) as held:
        monkeypatch.setattr(ports, "DEFAULT_PORT", port_of(held))
        with bind("127.0.0.1", None) as found:
            assert port_of(held) < port_of(found) < port_of(held) + 100


def test_a_port_that_is_held_but_not_listened_on_is_taken_too():
    with socket.socket() as held:
        held.bind(("127.0.0.1", 0))
        with pytest.raises(PortTakenError):
            bind("127.0.0.1", port_of(held))


def test_a_host_that_is_not_ours_is_a_sentence():
    with pytest.raises(SettingsError, match=r"cannot listen on 203\.0\.113\.7"):
        bind("203.0.113.7", 0)
    with pytest.raises(SettingsError, match="cannot listen on no such host"):
        bind("no such host", 0)


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("127.0.0.1", "http://127.0.0.1:8765/"),
        ("0.0.0.0", "http://127.0.0.1:8765/"),
        ("::1", "http://[::1]:8765/"),
        ("::", "http://[::1]:8765/"),
        ("robot.local", "http://robot.local:8765/"),
    ],
)
def test_the_address_works_on_this_machine(host: str, expected: str):
    assert page_address(host, DEFAULT_PORT) == expected


def test_the_address_has_its_path_and_its_scheme_and_the_usual_port_is_not_written():
    assert page_address("127.0.0.1", 8765, "/studio", tls=True) == "https://127.0.0.1:8765/studio/"
    assert page_address("127.0.0.1", 443, tls=True) == "https://127.0.0.1/"
    assert page_address("127.0.0.1", 80) == "http://127.0.0.1/"


def test_others_find_it_under_the_address_of_the_network_and_the_name_of_the_machine():
    assert lan_addresses("127.0.0.1", 8765) == ()
    assert lan_addresses("203.0.113.7", 8765) == ("http://203.0.113.7:8765/",)
    *numbers, name = lan_addresses("0.0.0.0", 8765)
    assert name == f"http://{socket.gethostname().lower().removesuffix('.local')}.local:8765/"
    assert not any("127.0.0.1" in one or "[" in one for one in numbers)
