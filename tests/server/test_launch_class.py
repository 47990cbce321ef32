"""A class of a real studio: its options, TLS of its own, and coming back after it was killed."""

from __future__ import annotations

import hashlib
import signal
import socket
import ssl
from contextlib import closing
from typing import TYPE_CHECKING

import pytest

from tests.support.classmates import Classmate
from tests.support.command_line import studio as command
from tests.support.nginx import free_port
from tests.support.server import running_studio

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network
WORDS = ["demo", "--share", "--host", "127.0.0.1", "--tls", "self"]


def untrusting() -> ssl.SSLContext:
    """A context that takes any certificate; which one it is, is compared by its fingerprint."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    return context


def test_it_is_encrypted_and_all_come_back_after_the_studio_was_killed(tmp_path: Path):
    data, port = tmp_path / "data", free_port()
    with running_studio(WORDS, data, port=port) as studio:
        assert studio.url.startswith(f"https://127.0.0.1:{port}/?token=")
        code = studio.class_code
        assert studio.next_line("SHA-256").split()[-1] == fingerprint_at(port)
        ada = Classmate(studio.url, untrusting())
        assert ada.join("Ada", code).status_code == 303
        with ada.lane() as lane:
            person = lane.until("you")["person"]
        studio.process.send_signal(signal.SIGKILL)
        studio.process.wait(60)
    with closing(ada), running_studio(WORDS, data, port=port) as studio:
        assert studio.class_code == code
        with ada.lane() as lane:
            assert lane.until("you", name="Ada")["person"] == person
            assert lane.newest("control")["holder"] == ""
        owner = Classmate(studio.url, untrusting())
        owner.client.get(f"/?token={studio.token}")
        with closing(owner), owner.lane() as lane:
            names = [one["name"] for one in lane.until("class_state")["members"]]
            assert names == ["Ada"]
            assert lane.ask("end_class")["type"] == "done"
        assert not list(data.glob("class-*.json"))
        assert ada.client.get("/d/rover").status_code == 403


def fingerprint_at(port: int) -> str:
    """Of the certificate that is shown there."""
    with (
        socket.create_connection(("127.0.0.1", port), 60) as plain,
        untrusting().wrap_socket(plain) as opened,
    ):
        certificate = opened.getpeercert(binary_form=True)
    assert certificate is not None
    return hashlib.sha256(certificate).digest().hex(":").upper()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--trust", "--share"], "--trust is for you alone"),
        (["--trust", "--trusted-proxy", "127.0.0.1"], "--trust is for you alone"),
        (["--trust", "--no-token"], "--trust is for you alone"),
        (["--trust", "--viewer-link"], "--trust is for you alone"),
        (["--trust", "--host", "0.0.0.0"], "--trust is for you alone"),
        (["--tls-cert", "x.pem"], "belong together"),
        (["--tls", "self", "--tls-cert", "x", "--tls-key", "y"], "Choose one"),
        (["--tls-cert", "/no/x.pem", "--tls-key", "/no/y.pem"], "cannot use the certificate"),
        (["--public-url", "robots.example"], "--public-url"),
        (["--base-path", "/a b"], "--base-path"),
        (["--trusted-proxy", "nginx"], "--trusted-proxy"),
    ],
)
def test_options_that_do_not_go_together_are_refused_in_one_sentence(
    tmp_path: Path, words: list[str], sentence: str
):
    line = ["demo", *words, "--no-browser", "--no-graph", "--port", "0", "--data-dir", tmp_path]
    done = command(*map(str, line))
    assert done.code == 2
    assert sentence in done.err
    assert len(done.err.strip().splitlines()) == 1
