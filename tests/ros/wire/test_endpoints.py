"""Endpoints are read as Zenoh writes them, and nothing else is."""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import WireSettingsError
from studio.ros.wire.endpoints import parse_endpoint


@pytest.mark.parametrize(
    ("text", "protocol", "host", "port"),
    [
        ("tcp/127.0.0.1:7447", "tcp", "127.0.0.1", 7447),
        ("tcp/localhost:7447", "tcp", "localhost", 7447),
        ("tls/[::1]:7448", "tls", "::1", 7448),
        ("tcp/[::]:7447?prio=6-7#iface=eth0", "tcp", "::", 7447),
        ("quic/robot.local:1", "quic", "robot.local", 1),
        ("unixsock-stream//tmp/zenoh.sock", "unixsock-stream", "", 0),
    ],
)
def test_an_endpoint_is_parted(text: str, protocol: str, host: str, port: int):
    found = parse_endpoint(text)
    assert (found.text, found.protocol, found.host, found.port) == (text, protocol, host, port)


@pytest.mark.parametrize("host", ["127.0.0.1", "127.9.9.9", "localhost", "[::1]"])
def test_loopback_is_what_only_this_machine_reaches(host: str):
    assert parse_endpoint(f"tcp/{host}:1").is_loopback


@pytest.mark.parametrize("host", ["192.0.2.7", "[::]", "0.0.0.0", "localhost.example", "robot"])
def test_other_places_are_no_loopback(host: str):
    assert not parse_endpoint(f"tcp/{host}:1").is_loopback


@pytest.mark.parametrize(
    "text",
    [
        "",
        "tcp",
        "7447",
        "127.0.0.1:7447",
        "tcp/127.0.0.1",
        "tcp/:1",
        "tcp/a:65536",
        "tcp/a:0",
        "tcp/a:-1",
    ],
)
def test_what_is_no_endpoint_is_refused_with_an_example(text: str):
    with pytest.raises(WireSettingsError, match=r"tcp/127\.0\.0\.1:7447"):
        parse_endpoint(text)


@pytest.mark.parametrize("host", ["a..b", ".", "x" * 64, "ß" * 64, "robot." + "x" * 64])
def test_a_host_that_no_resolver_takes_is_refused(host: str):
    with pytest.raises(WireSettingsError, match="is no host name"):
        parse_endpoint(f"tcp/{host}:7447")


@given(st.text(alphabet="tcpls/[]:.?#0179٣x", max_size=30))
def test_any_text_is_an_endpoint_or_refused(text: str):
    with suppress(WireSettingsError):
        assert parse_endpoint(text).text == text
