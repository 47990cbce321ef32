"""Where the router is looked for: options first, then the environment of ROS."""

from __future__ import annotations

import pytest

from studio.errors import WireSettingsError
from studio.live.connection.plan import chosen_wire, planned_wire
from studio.protocol.connection import ConnectWire
from studio.ros.wire.settings import ROUTER_ENDPOINT
from studio.settings import WireChoice

ENVIRONMENT = ("ROS_DOMAIN_ID", "ROS_DISTRO", "ZENOH_SESSION_CONFIG_URI", "ZENOH_CONFIG_OVERRIDE")


@pytest.fixture(autouse=True)
def plain_environment(monkeypatch: pytest.MonkeyPatch):
    for name in ENVIRONMENT:
        monkeypatch.delenv(name, raising=False)


def test_without_a_word_it_is_the_usual_router_of_this_machine():
    planned = planned_wire(WireChoice())
    assert (planned.connect, planned.domain) == ((ROUTER_ENDPOINT,), 0)
    assert planned.profile.distro == "jazzy"


def test_the_environment_counts_where_no_option_does(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "7")
    monkeypatch.setenv("ROS_DISTRO", "humble")
    assert planned_wire(WireChoice()).domain == 7
    assert planned_wire(WireChoice(domain=3)).domain == 3
    assert planned_wire(WireChoice()).profile.distro == "humble"


def test_a_router_that_is_named_is_the_one():
    assert planned_wire(WireChoice("tcp/127.0.0.1:9")).connect == ("tcp/127.0.0.1:9",)
    assert planned_wire(WireChoice("off", ("tcp/a:1",))).connect == ("tcp/a:1",)


def test_a_domain_that_is_none_is_an_error(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("ROS_DOMAIN_ID", "many")
    with pytest.raises(WireSettingsError):
        planned_wire(WireChoice())


def test_a_distribution_that_was_chosen_comes_before_that_of_the_environment(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setenv("ROS_DISTRO", "humble")
    assert planned_wire(WireChoice(distro="kilted")).profile.distro == "kilted"


@pytest.mark.parametrize(
    ("address", "endpoint"),
    [
        ("robot.local", "tcp/robot.local:7447"),
        (" 192.0.2.7:7448 ", "tcp/192.0.2.7:7448"),
        ("tls/robot", "tls/robot:7447"),
        ("tcp/[::1]:9", "tcp/[::1]:9"),
        ("[::1]", "tcp/[::1]:7447"),
        ("::1", "tcp/[::1]:7447"),
        ("fe80::1:2", "tcp/[fe80::1:2]:7447"),
        ("unixsock-stream/zenoh", "unixsock-stream/zenoh"),
    ],
)
def test_an_address_is_taken_as_people_write_it(address: str, endpoint: str):
    assert chosen_wire(WireChoice(), ConnectWire(address=address)).connect == (endpoint,)


@pytest.mark.parametrize("address", ["http://robot", "a b", "tcp/", "robot:0", "x:99999999", "/"])
def test_an_address_that_is_none_is_an_error(address: str):
    with pytest.raises(WireSettingsError):
        chosen_wire(WireChoice(), ConnectWire(address=address))


def test_what_a_person_leaves_out_stays_as_it_was():
    before = WireChoice("tcp/127.0.0.1:9", ("tcp/a:1",), 4, "humble")
    assert chosen_wire(before, ConnectWire()) == before
    assert chosen_wire(before, ConnectWire(domain=0)) == WireChoice(
        "tcp/127.0.0.1:9", ("tcp/a:1",), 0, "humble"
    )
    elsewhere = chosen_wire(before, ConnectWire(address="tcp/b:2", distro="jazzy"))
    assert elsewhere == WireChoice("auto", ("tcp/b:2",), 4, "jazzy")
    assert chosen_wire(WireChoice("off"), ConnectWire(address="b")).router == "off"
