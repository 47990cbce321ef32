"""The wire opens by joining a router or by starting one, and says why when it can do neither."""

from __future__ import annotations

import socket
from contextlib import closing

import pytest

from studio.errors import (
    ForeignEndpointError,
    NoRouterError,
    RouterNotStartedError,
    WireSettingsError,
)
from studio.ros.wire import endpoints as probing
from studio.ros.wire.session import open_wire
from studio.ros.wire.settings import WireSettings
from tests.support.wire import free_endpoint, running_router


def at(endpoint: str) -> WireSettings:
    return WireSettings(connect=(endpoint,))


def test_the_first_starts_a_router_and_the_second_joins_it():
    endpoint = free_endpoint()
    with open_wire(at(endpoint)) as first, open_wire(at(endpoint)) as second:
        assert first.router is not None
        assert second.router is None
        assert [str(zid) for zid in second.zenoh.info.routers_zid()] == [first.router.zid]


def test_a_router_that_is_there_is_joined():
    with running_router() as endpoint, open_wire(at(endpoint)) as wire:
        assert wire.router is None


def test_off_starts_no_router():
    endpoint = free_endpoint()
    with pytest.raises(NoRouterError, match=endpoint):
        open_wire(at(endpoint), router="off")


def test_an_endpoint_given_as_router_is_started_and_joined():
    endpoint = free_endpoint()
    with open_wire(at(free_endpoint()), router=endpoint) as wire:
        assert wire.router is not None
        assert wire.settings.connect == (endpoint,)


def test_no_router_is_started_where_others_could_reach_it():
    """192.0.2.1 is no machine's: RFC 5737 keeps it for texts."""
    with pytest.raises(NoRouterError):
        open_wire(at("tcp/192.0.2.1:7447"))


def test_closing_the_session_closes_its_router():
    endpoint = free_endpoint()
    open_wire(at(endpoint)).close()
    with pytest.raises(NoRouterError):
        open_wire(at(endpoint), router="off")


@pytest.mark.parametrize("router", ["auto", "off"])
def test_what_is_no_zenoh_is_named_in_one_sentence(router: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(probing, "ANSWER_TIMEOUT_S", 0.3)
    with closing(socket.create_server(("127.0.0.1", 0))) as other:
        endpoint = f"tcp/127.0.0.1:{other.getsockname()[1]}"
        with pytest.raises(ForeignEndpointError, match=endpoint):
            open_wire(at(endpoint), router)


def test_an_endpoint_that_is_no_place_of_this_machine_is_told():
    with pytest.raises(RouterNotStartedError, match=r"192\.0\.2\.1"):
        open_wire(at(free_endpoint()), router="tcp/192.0.2.1:7447")


@pytest.mark.parametrize("text", ["on", "", "tcp/", "tcp/127.0.0.1", "tcp/127.0.0.1:x", "http/a:1"])
def test_a_choice_that_is_none_is_refused(text: str):
    with pytest.raises(WireSettingsError, match="no endpoint"):
        open_wire(at(free_endpoint()), router=text)
