from __future__ import annotations

import pytest

from studio.errors import WireSettingsError
from studio.ros.profiles import profile_named
from studio.ros.wire.settings import ROUTER_ENDPOINT, WireSettings, environment_for, wire_settings

FAR = "tcp/192.0.2.7:7447"


def test_without_options_and_environment_the_router_of_this_machine_is_meant():
    found = wire_settings(environment={})
    assert (found.connect, found.domain, found.overrides) == ((ROUTER_ENDPOINT,), 0, {})


def test_options_come_before_the_environment():
    environment = {
        "ROS_DOMAIN_ID": "7",
        "ZENOH_CONFIG_OVERRIDE": 'connect/endpoints=["tcp/192.0.2.9:1"]',
    }
    assert wire_settings((FAR,), 3, environment=environment).connect == (FAR,)
    assert wire_settings((FAR,), 3, environment=environment).domain == 3
    assert wire_settings(environment=environment).domain == 7


@pytest.mark.parametrize("written", [f'["{FAR}"]', f"['{FAR}',]", f' [ "{FAR}" ] '])
def test_routers_named_in_the_override_are_those_to_connect_to(written: str):
    """Else a router of our own would be started where nobody asked for one."""
    override = f'mode="client";connect/endpoints={written};transport/shared_memory/enabled=false'
    found = wire_settings(environment={"ZENOH_CONFIG_OVERRIDE": override})
    assert found.connect == (FAR,)
    assert set(found.overrides) == {"mode", "transport/shared_memory/enabled"}


@pytest.mark.parametrize("written", ["7447", "{a: 1}", "[1]", "[", ""])
def test_routers_that_are_no_list_are_refused(written: str):
    with pytest.raises(WireSettingsError, match="write a list such as"):
        wire_settings(environment={"ZENOH_CONFIG_OVERRIDE": f"connect/endpoints={written}"})


@pytest.mark.parametrize("written", ["-1", "233", "one", "1.5"])
def test_a_domain_that_is_none_is_refused(written: str):
    with pytest.raises(WireSettingsError, match="ROS_DOMAIN_ID"):
        wire_settings(environment={"ROS_DOMAIN_ID": written})


@pytest.mark.parametrize(
    ("named", "spoken"),
    [("humble", "humble"), ("Kilted", "kilted"), ("foxy", "jazzy"), ("", "jazzy")],
)
def test_the_distribution_is_that_of_the_shell_where_it_is_known(named: str, spoken: str):
    assert wire_settings(environment={"ROS_DISTRO": named}).profile.distro == spoken


def test_files_of_configuration_are_those_of_the_environment():
    environment = {
        "ZENOH_SESSION_CONFIG_URI": "/sessions.json5",
        "ZENOH_ROUTER_CONFIG_URI": " /router.json5 ",
    }
    found = wire_settings(environment=environment)
    assert (found.config_file, found.router_config_file) == ("/sessions.json5", "/router.json5")
    assert wire_settings(environment={}).router_config_file is None


def test_nodes_join_the_same_routers_and_domain_and_keep_the_rest_of_the_environment():
    settings = WireSettings(
        connect=("tcp/127.0.0.1:1", "tcp/127.0.0.1:2"), domain=7, profile=profile_named("humble")
    )
    environment = environment_for(settings, {"A": "b", "ZENOH_CONFIG_OVERRIDE": "x=1;y=2"})
    found = wire_settings(environment=environment)
    assert (found.connect, found.domain) == (settings.connect, settings.domain)
    assert found.overrides == {"x": "1", "y": "2"}
    assert environment["A"] == "b"
    assert found.profile == settings.profile
