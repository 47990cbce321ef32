"""Sessions take Zenoh's configuration: files, single keys, certificates, names and passwords."""

from __future__ import annotations

import json
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotAdmittedError, WireSettingsError
from studio.ros.wire.endpoints import parse_endpoint
from studio.ros.wire.router import start_router
from studio.ros.wire.session import open_wire, zenoh_config
from studio.ros.wire.settings import WireSettings
from tests.support.certificates import make_certificates
from tests.support.wire import free_endpoint, open_test_session, running_router, session_pair

if TYPE_CHECKING:
    from pathlib import Path

ROUTERS = ("auto", "off")
TLS = "transport/link/tls"
USER = "transport/auth/usrpwd"


def keys(root: str, **values: object) -> dict[str, str]:
    return {f"{root}/{key}": json.dumps(str(value)) for key, value in values.items()}


def test_nodes_and_endpoints_of_a_session_share_one_counter():
    with running_router() as endpoint, open_test_session(endpoint) as wire:
        assert [wire.next_id() for _ in range(3)] == [0, 1, 2]


def test_a_session_is_known_to_others_by_its_id():
    with session_pair() as (one, other):
        assert one.zid == str(one.zenoh.info.zid())
        assert one.zid != other.zid


def test_a_closed_session_may_be_closed_again():
    with running_router() as endpoint, open_test_session(endpoint) as wire:
        wire.close()
        assert wire.zenoh.is_closed()


def test_a_configuration_file_is_taken_whole_and_keys_come_on_top(tmp_path: Path):
    file = tmp_path / "session.json5"
    file.write_text("{ mode: 'peer', scouting: { multicast: { enabled: false } } }")
    with running_router() as endpoint:
        settings = WireSettings(
            connect=(),
            config_file=str(file),
            overrides={"connect/endpoints": json.dumps([endpoint])},
        )
        config = zenoh_config(settings)
        assert json.loads(config.get_json("mode")) == "peer"
        with open_wire(settings, "off") as wire:
            assert len(list(wire.zenoh.info.routers_zid())) == 1


@pytest.mark.parametrize(
    "settings",
    [
        WireSettings(config_file="/nowhere/session.json5"),
        WireSettings(overrides={"no/such/key": "1"}),
        WireSettings(overrides={"mode": "["}),
        WireSettings(overrides={"mode": '"captain"'}),
    ],
    ids=["no file", "no key", "no JSON5", "no mode"],
)
def test_a_configuration_that_cannot_be_is_one_sentence(settings: WireSettings):
    with pytest.raises(WireSettingsError) as caught:
        zenoh_config(settings)
    assert ".rs" not in str(caught.value)


def test_tls_joins_the_router_whose_authority_is_known(tmp_path: Path):
    known, other = make_certificates(tmp_path), make_certificates(tmp_path, "stranger")
    endpoint = free_endpoint("tls")
    ours = keys(TLS, listen_private_key=known.key, listen_certificate=known.certificate)
    with start_router(parse_endpoint(endpoint), ours):
        for router in ROUTERS:
            trusting = keys(TLS, root_ca_certificate=known.authority)
            with open_wire(WireSettings(connect=(endpoint,), overrides=trusting), router) as wire:
                assert wire.router is None
        for authority in (other.authority, None):
            wrong = keys(TLS, root_ca_certificate=authority) if authority else {}
            with pytest.raises(NotAdmittedError, match=endpoint):
                open_wire(WireSettings(connect=(endpoint,), overrides=wrong), "off")


def test_a_router_of_our_own_speaks_tls_when_the_settings_say_so(tmp_path: Path):
    made = make_certificates(tmp_path)
    settings = WireSettings(
        connect=(free_endpoint("tls"),),
        overrides=keys(
            TLS,
            listen_private_key=made.key,
            listen_certificate=made.certificate,
            root_ca_certificate=made.authority,
        ),
    )
    with open_wire(settings) as first, open_wire(settings) as second:
        assert first.router is not None
        assert second.router is None


def test_a_name_and_its_password_are_asked_for(tmp_path: Path):
    users = tmp_path / "users.txt"
    users.write_text("studio:secret\nrobot:word\n")
    endpoint = free_endpoint()
    ours = keys(USER, dictionary_file=users, user="studio", password="secret")
    with ExitStack() as stack:
        stack.enter_context(start_router(parse_endpoint(endpoint), ours))
        for router in ROUTERS:
            right = keys(USER, user="robot", password="word")
            settings = WireSettings(connect=(endpoint,), overrides=right)
            assert stack.enter_context(open_wire(settings, router)).router is None
        for wrong in (keys(USER, user="robot", password="secret"), {}):
            with pytest.raises(NotAdmittedError, match=endpoint):
                open_wire(WireSettings(connect=(endpoint,), overrides=wrong), "off")
