# pyright: reportPrivateUsage=false
"""The key of a relay: who has it connects, and cannot pass for the relay."""

from __future__ import annotations

import base64
import json
import string
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from typing import TYPE_CHECKING

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import serialization
from cryptography.hazmat.primitives.asymmetric import ec
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import RelayKeyError, RelayLineError
from studio.ros.wire.certificates import derived_key, key_pem, new_secret
from studio.ros.wire.credentials import Credentials
from studio.ros.wire.zenoh import ZError, close, insert, open_zenoh, read_config
from studio.server.relays import keys
from studio.server.relays.keys import (
    KEY_LETTERS,
    RelayAddress,
    RelayIdentity,
    parse_relay_line,
)
from tests.support.wire import free_endpoint

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.wire.zenoh import Config, Session

RELAY = RelayIdentity("5e" * 32)
"""Always the same, for its key is in the names of tests."""
LINE = f"tls/relay.example:7448#{RELAY.key}"
LETTERS = string.ascii_letters + string.digits + "-_"


def _alone(mode: str, overrides: dict[str, str]) -> Config:
    config = read_config()
    insert(config, "mode", json.dumps(mode))
    insert(config, "scouting/delay", "0")
    insert(config, "scouting/multicast/enabled", "false")
    for key, json5 in overrides.items():
        insert(config, key, json5)
    return config


@contextmanager
def listening(credentials: Credentials) -> Generator[str]:
    endpoint = free_endpoint("tls")
    overrides = credentials.of_router()
    session = open_zenoh(
        _alone("router", {**overrides, "listen/endpoints": json.dumps([endpoint])})
    )
    try:
        yield endpoint
    finally:
        close(session)


@contextmanager
def connected(endpoint: str, credentials: Credentials | None) -> Generator[Session]:
    """A client that tries once."""
    overrides = {} if credentials is None else credentials.of_session()
    session = open_zenoh(
        _alone("client", {**overrides, "connect/endpoints": json.dumps([endpoint])})
    )
    try:
        yield session
    finally:
        close(session)


def is_linked(endpoint: str, credentials: Credentials) -> bool:
    with connected(endpoint, credentials) as session:
        return len(session.info.routers_zid()) == 1


def assert_refused(endpoint: str, credentials: Credentials | None) -> None:
    with pytest.raises(ZError, match="Unable to connect"), connected(endpoint, credentials):
        pass


def own_of(secret: str) -> Credentials:
    return RelayAddress("tls/relay.example:7448", RelayIdentity(secret).key).credentials


def test_who_has_the_line_connects_and_each_time_with_another_certificate():
    with listening(RELAY.credentials) as endpoint:
        address = parse_relay_line(f"{endpoint}#{RELAY.key}")
        assert address.endpoint == endpoint
        one, other = address.credentials, address.credentials
        assert one.key != other.key
        assert is_linked(endpoint, one)
        assert is_linked(endpoint, other)


def test_a_relay_that_starts_anew_has_the_same_key_and_is_known_by_it():
    secret = new_secret()
    address = parse_relay_line(f"tls/relay.example:7448#{RelayIdentity(secret).key}")
    with listening(RelayIdentity(secret).credentials) as endpoint:
        assert is_linked(endpoint, address.credentials)


def test_an_origin_with_another_key_or_half_of_the_right_one_is_refused():
    right = parse_relay_line(LINE).credentials
    stranger = own_of(new_secret())
    with listening(RELAY.credentials) as endpoint:
        assert is_linked(endpoint, right)
        assert_refused(endpoint, stranger)
        # Of the first the relay does not know the authority, the second not that of the relay.
        assert_refused(endpoint, Credentials(right.authority, stranger.certificate, stranger.key))
        assert_refused(endpoint, Credentials(stranger.authority, right.certificate, right.key))


def test_a_client_without_a_certificate_is_refused():
    with listening(RELAY.credentials) as endpoint:
        assert_refused(endpoint, None)
        # That it trusts the relay is not enough: of its own it shows nothing.
        trusting = parse_relay_line(LINE).credentials.of_session()
        shown = {
            key: json5
            for key, json5 in trusting.items()
            if "connect_" not in key and "enable_mtls" not in key
        }
        overrides = {
            **shown,
            "transport/link/tls/enable_mtls": "false",
            "connect/endpoints": json.dumps([endpoint]),
        }
        with pytest.raises(ZError, match="Unable to connect"):
            open_zenoh(_alone("client", overrides))


def impostors() -> dict[str, Credentials]:
    """What who has the key can listen by: all that is made of it, and keys of their own."""
    public, seed = keys._read_key(RELAY.key)
    studios, known = keys._studios(seed)
    own = ec.generate_private_key(ec.SECP256R1())
    private = key_pem(own)

    def signed(issuer: str, by: ec.EllipticCurvePrivateKey) -> str:
        return keys._certificate(keys._RELAY, own.public_key(), issuer, by, serves=True)

    of_client = parse_relay_line(LINE).credentials
    below = signed(keys._AUTHORITY, own)
    of_relay = keys._certificate(keys._RELAY, public, keys._AUTHORITY, own, serves=True)
    return {
        "signed by the studios' authority": Credentials(
            known, signed(keys._STUDIOS, studios), private
        ),
        "by the same, in the name of the relay's": Credentials(
            known, signed(keys._AUTHORITY, studios), private
        ),
        "by a key of their own, in the name of the relay's": Credentials(known, below, private),
        "with an authority of that name in its chain": Credentials(
            known,
            below + keys._certificate(keys._AUTHORITY, own.public_key(), keys._AUTHORITY, own),
            private,
        ),
        "with the anchor in its chain": Credentials(known, below + keys._anchor(public), private),
        "a studio's": Credentials(known, of_client.certificate, of_client.key),
        "with a relay's public key below the anchor": Credentials(
            known, signed(keys._AUTHORITY, own) + of_relay, private
        ),
    }


@pytest.mark.parametrize("how", impostors())
def test_who_has_only_the_key_cannot_pass_for_the_relay(how: str):
    with listening(impostors()[how]) as endpoint:
        assert_refused(endpoint, parse_relay_line(LINE).credentials)


def test_the_impostors_are_refused_for_their_authority_alone():
    """Else the test of the impostors would show nothing."""
    how = "signed by the studios' authority"
    false, right = impostors()[how], parse_relay_line(LINE).credentials
    with listening(false) as endpoint:
        assert is_linked(endpoint, Credentials(false.authority, right.certificate, right.key))


def test_certificates_are_valid_where_clocks_differ_by_an_hour_and_for_years():
    for one in (RELAY.credentials, parse_relay_line(LINE).credentials):
        for text in (one.certificate, one.authority):
            read = x509.load_pem_x509_certificate(text.encode())
            now = datetime.now(UTC)
            assert read.not_valid_before_utc < now - timedelta(hours=1)
            assert read.not_valid_after_utc > now + timedelta(days=1000)


def test_the_key_holds_no_private_key_of_the_relay():
    public, seed = keys._read_key(RELAY.key)
    loaded = serialization.load_pem_private_key(RELAY.credentials.key.encode(), None)
    assert isinstance(loaded, ec.EllipticCurvePrivateKey)
    derived = {name: derived_key(seed, name) for name in (keys._AUTHORITY, keys._RELAY)}
    assert keys._point(public) not in {keys._point(one.public_key()) for one in derived.values()}
    assert keys._point(loaded.public_key()) != keys._point(derived[keys._RELAY].public_key())


@pytest.mark.parametrize("secret", ["", "00", "zz" * 32, "00" * 31, "00" * 33])
def test_what_is_no_secret_makes_no_relay(secret: str):
    with pytest.raises(ValueError, match=r"secret|hex"):
        RelayIdentity(secret)


def test_what_the_relay_signed_is_known_and_nothing_else():
    address = parse_relay_line(LINE)
    signature = RELAY.sign(b"said")
    address.verify(b"said", signature)
    for data, by in (
        (b"other", signature),
        (b"said", b""),
        (b"said", signature[:-1]),
        (b"said", RelayIdentity(new_secret()).sign(b"said")),
    ):
        with pytest.raises(RelayLineError, match="not signed by the relay"):
            address.verify(data, by)


def test_a_certificate_is_no_message_that_the_relay_signed():
    read = x509.load_pem_x509_certificate(RELAY.credentials.certificate.encode())
    with pytest.raises(RelayLineError):
        parse_relay_line(LINE).verify(read.tbs_certificate_bytes, read.signature)


@given(st.integers(0, KEY_LETTERS - 1), st.sampled_from(LETTERS))
def test_a_key_with_another_letter_proves_nothing(at: int, letter: str):
    given_key = RELAY.key[:at] + letter + RELAY.key[at + 1 :]
    assert RELAY.proves(given_key) == (given_key == RELAY.key)


@pytest.mark.parametrize("other", ["", "é", "\ud800", "x" * 10_000])
def test_what_is_no_key_proves_nothing(other: str):
    assert RELAY.proves(RELAY.key)
    assert not RELAY.proves(other)


@pytest.mark.parametrize(
    ("text", "endpoint"),
    [
        (LINE, "tls/relay.example:7448"),
        (f"  {LINE}\n", "tls/relay.example:7448"),
        (f"{LINE[:50]}\r\n  {LINE[50:]}", "tls/relay.example:7448"),
        (f"tls/Relay.EXAMPLE:07448#{RELAY.key}", "tls/relay.example:7448"),
        (f"tls/127.0.0.1:1#{RELAY.key}", "tls/127.0.0.1:1"),
        (f"tls/[FE80::1%eth0]:7448#{RELAY.key}", "tls/[fe80::1%eth0]:7448"),
        (f"tls/::1:7448#{RELAY.key}", "tls/[::1]:7448"),
        (f"tls/schülerrechner:7448#{RELAY.key}", "tls/xn--schlerrechner-yob:7448"),
    ],
)
def test_a_line_is_read_as_it_was_copied(text: str, endpoint: str):
    address = parse_relay_line(text)
    assert (address.endpoint, address.key) == (endpoint, RELAY.key)
    assert parse_relay_line(f"{address.endpoint}#{address.key}") == address


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "no #"),
        ("tls/relay.example:7448", "no #"),
        (f"tls/relay.example:7448{RELAY.key}", "no #"),
        (f"relay.example:7448#{RELAY.key}", "no endpoint"),
        (f"tls/relay.example#{RELAY.key}", "no endpoint"),
        (f"tls/relay.example:0#{RELAY.key}", "no endpoint"),
        (f"tls/{'a' * 70}:1#{RELAY.key}", "no endpoint"),
        (f"tcp/relay.example:7448#{RELAY.key}", "begin with tls/"),
        (f"tls/relay.example:7448?prio=1#{RELAY.key}", "more than tls/"),
        (f'tls/rel"ay;:7448#{RELAY.key}', "more than tls/"),
        (f"tls/me@relay.example:7448#{RELAY.key}", "more than tls/"),
        (LINE[:-1], "67 letters instead of 68"),
        (f"{LINE}=", "69 letters"),
        (f"{LINE}{LINE}", "letters"),
        (LINE[:-1] + "+", "letter"),
        (LINE[:-1] + "=", "letter"),
        (LINE[:-1] + "é", "letter"),
        (f"tls/relay.example:7448#{'A' * KEY_LETTERS}", "changed"),
    ],
)
def test_what_is_no_line_is_told_in_a_sentence_that_does_not_repeat_it(text: str, reason: str):
    with pytest.raises(RelayKeyError, match=reason) as error:
        parse_relay_line(text)
    assert RELAY.key[:20] not in f"{error.value} {error.value!r} {vars(error.value)}"


@given(st.text(max_size=120))
def test_any_text_is_a_line_or_a_mistake(text: str):
    with pytest.raises(RelayKeyError):
        parse_relay_line(text)


@given(st.text(max_size=70), st.integers(-1, 70_000))
def test_any_host_and_port_are_an_address_that_is_read_again_or_a_mistake(host: str, port: int):
    try:
        address = parse_relay_line(f"tls/{host}:{port}#{RELAY.key}")
    except RelayKeyError:
        return
    assert parse_relay_line(f"{address.endpoint}#{address.key}") == address


@given(st.binary(min_size=51, max_size=51))
def test_any_letters_as_a_key_are_one_or_a_mistake(data: bytes):
    key = base64.urlsafe_b64encode(data).decode()
    try:
        address = parse_relay_line(f"tls/relay.example:7448#{key}")
    except RelayKeyError:
        return
    assert address.credentials.authority


def test_an_address_does_not_show_its_key():
    address = parse_relay_line(LINE)
    assert str(address) == "tls/relay.example:7448"
    for shown in (repr(address), f"{address}", str([address]), f"{address!r:>200}"):
        assert RELAY.key not in shown
