from __future__ import annotations

import signal
from typing import TYPE_CHECKING

import pytest

from studio.server.relays.keys import RelayAddress, parse_relay_line
from tests.support.command_line import studio
from tests.support.nginx import free_port
from tests.support.relay import running_relay

if TYPE_CHECKING:
    from pathlib import Path


network = pytest.mark.network


def test_its_help_names_what_it_takes():
    ran = studio("relay", "--help")
    assert (ran.code, ran.err) == (0, "")
    for option in ("--listen", "--name", "--new-key", "--print", "--public-url", "--data-dir"):
        assert option in ran.out


@pytest.mark.parametrize("more", [(), ("--print", "systemd")], ids=["served", "printed"])
@pytest.mark.parametrize("listen", ["tcp/0.0.0.0:7448", "quic/0.0.0.0:7448", "nonsense"])
def test_studios_dial_in_encrypted_only(listen: str, more: tuple[str, ...], tmp_path: Path):
    ran = studio("relay", "--listen", listen, "--data-dir", str(tmp_path), *more)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err.startswith("studio: ")
    assert listen in ran.err
    assert ran.err.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", ["systemd", "compose", "nginx"])
def test_a_text_is_printed_without_a_key_being_made(kind: str, tmp_path: Path):
    data = tmp_path / "data"
    ran = studio("relay", "--print", kind, "--data-dir", str(data))
    assert (ran.code, ran.err) == (0, "")
    assert "studio relay" in ran.out
    assert ran.out.endswith("\n")
    assert not data.exists()


def test_a_key_file_that_holds_no_key_is_told_and_left_as_it_is(tmp_path: Path):
    kept = tmp_path / "relay.key"
    for text in ("", "not a key", "ab" * 31, "é"):
        kept.write_text(text)
        listen = f"tls/127.0.0.1:{free_port()}"
        ran = studio("relay", "--listen", listen, "--port", "0", "--data-dir", str(tmp_path))
        assert ran.code == 2
        assert "--new-key" in ran.err
        assert ran.err.count("\n") == 1
        assert kept.read_text() == text


def once(data: Path, *more: str) -> RelayAddress:
    """Start it, and end it; what studios are given to dial in by."""
    words = ("--listen", f"tls/127.0.0.1:{free_port()}", "--port", "0", *more)
    with running_relay(words, data) as relay:
        assert relay.process.stop(signal.SIGTERM) == 0
        return parse_relay_line(relay.line)


@network
def test_its_key_is_kept_for_its_owner_alone_until_another_is_wanted(tmp_path: Path):
    data = tmp_path / "data"
    first = once(data)
    kept = data / "relay.key"
    assert kept.stat().st_mode & 0o777 == 0o600
    assert once(data).key == first.key
    other = once(data, "--new-key")
    assert other.key != first.key
    assert kept.stat().st_mode & 0o777 == 0o600
    assert once(data).key == other.key


@network
def test_its_line_names_it_as_it_was_told(tmp_path: Path):
    """Behind a proxy elsewhere, studios find it by another name than people do."""
    port = free_port()
    words = ["--listen", f"tls/0.0.0.0:{port}", "--port", "0"]
    words += ["--public-url", "https://robots.example.org/", "--trusted-proxy", "192.0.2.9"]
    with running_relay(words, tmp_path) as relay:
        assert relay.address == "https://robots.example.org/"
        assert relay.line.startswith(f"tls/robots.example.org:{port}#")
    with running_relay([*words, "--name", "relay.example.org"], tmp_path) as relay:
        assert relay.address == "https://robots.example.org/"
        assert relay.line.startswith(f"tls/relay.example.org:{port}#")
        assert "studio: " not in relay.process.printed


@network
@pytest.mark.parametrize(
    ("host", "told"),
    [("127.0.0.1", "Only this machine finds the page"), ("0.0.0.0", "The page is not encrypted")],
)
def test_what_people_would_stumble_over_is_told(host: str, told: str, tmp_path: Path):
    words = ["--listen", f"tls/127.0.0.1:{free_port()}", "--port", "0", "--host", host]
    with running_relay(words, tmp_path) as relay:
        assert relay.process.printed.count("studio: ") == 1
        assert f"studio: {told}" in relay.process.printed


@network
def test_a_port_that_is_taken_is_one_sentence(tmp_path: Path):
    listen = f"tls/127.0.0.1:{free_port()}"
    with running_relay(["--listen", listen, "--port", "0"], tmp_path / "one"):
        ran = studio("relay", "--listen", listen, "--port", "0", "--data-dir", str(tmp_path))
        assert ran.code == 2
        assert listen in ran.err
        assert "choose another --listen" in ran.err
        assert "Traceback" not in ran.err
