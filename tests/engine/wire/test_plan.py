"""Where the router is looked for: options first, then the environment of ROS."""

from __future__ import annotations

import pytest

from studio.engine.wire.plan import planned_wire
from studio.errors import WireSettingsError
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
