from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.server.origin import Authority, KnownHosts, is_loopback, is_same_origin, parse_authority


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("localhost:8765", Authority("localhost", 8765)),
        ("LOCALHOST", Authority("localhost", None)),
        ("[::1]:80", Authority("::1", 80)),
        ("", None),
        (":80", None),
        ("a b:80", Authority("a b", 80)),
        ("a:b", None),
        ("a:99999", None),
        ("a@b:80", None),
        ("a/b", None),
        ("a?b", None),
        ("a#b", None),
        ("[::1", None),
    ],
)
def test_an_authority_is_a_name_and_a_port(text: str, expected: Authority | None):
    assert parse_authority(text) == expected


@given(st.text(max_size=40))
def test_any_text_is_read_without_an_error(text: str):
    parse_authority(text)
    is_same_origin(text, Authority("localhost", 80))


@pytest.mark.parametrize(
    ("origin", "host", "expected"),
    [
        ("http://localhost:8765", Authority("localhost", 8765), True),
        ("https://robot.example", Authority("robot.example", None), True),
        ("https://robot.example", Authority("robot.example", 443), True),
        ("http://robot.example", Authority("robot.example", 80), True),
        ("http://robot.example:81", Authority("robot.example", 80), False),
        ("http://127.0.0.1:8765", Authority("localhost", 8765), False),
        ("null", Authority("null", None), False),
        ("file://", Authority("", None), False),
        ("chrome-extension://localhost:8765", Authority("localhost", 8765), False),
    ],
)
def test_an_origin_is_ours_when_it_was_served_under_this_host(
    origin: str, host: Authority, expected: bool
):
    assert is_same_origin(origin, host) is expected


def test_bound_to_loopback_only_its_names_are_known():
    hosts = KnownHosts.of("127.0.0.1")
    assert hosts.knows(Authority("localhost", None))
    assert not hosts.knows(Authority("192.168.1.7", None))
    assert not hosts.knows(Authority("evil.example", None))


def test_bound_to_a_name_that_name_is_known_too():
    hosts = KnownHosts.of("Robot.Local")
    assert hosts.knows(Authority("robot.local", None))
    assert not hosts.knows(Authority("evil.local", None))


@pytest.mark.parametrize(
    ("host", "expected"),
    [
        ("127.0.0.1", True),
        ("127.8.9.1", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("::", False),
        ("192.168.1.7", False),
        ("localhost.example", False),
        ("", False),
    ],
)
def test_only_this_machine_reaches_loopback(host: str, expected: bool):
    assert is_loopback(host) is expected
