"""This machine's network and its variables."""

from __future__ import annotations

from studio.live.doctor.asking import look_here
from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Here, Interface, Seen
from studio.live.doctor.subjects.network import findings
from studio.protocol.connection import WireReport

LOOP = Interface("lo", is_up=True, is_loopback=True, has_multicast=False)


def place(endpoint: str) -> WireReport:
    """Where a router is."""
    return WireReport(
        request=0, endpoint=endpoint, domain=0, distro="jazzy", verdict="fine",
        starts_router=False, nodes=1, domains=(), distros=(), types=(), unseen=0, bridges=(),
    )  # fmt: skip


def found(*interfaces: Interface, at: str = "tcp/192.0.2.7:7447", **variables: str) -> set[str]:
    """The codes of what is found."""
    here = Here((LOOP, *interfaces), variables)
    return {one.code for one in findings(Seen(here=here, place=place(at)))}


def test_a_machine_without_network_meets_nobody_else():
    down = Interface("eth0", is_up=False, is_loopback=False, has_multicast=True)
    assert found(down) == {"no-network"}


def test_multicast_is_not_needed_and_that_is_said():
    cable = Interface("eth0", is_up=True, is_loopback=False, has_multicast=False)
    (only,) = findings(Seen(here=Here((LOOP, cable)), place=place("tcp/192.0.2.7:7447")))
    assert (only.code, only.level) == ("no-multicast", "note")
    assert "rmw_zenoh needs none" in only.sentence


def test_an_address_of_this_machine_alone_is_a_note():
    cable = Interface("eth0", is_up=True, is_loopback=False, has_multicast=True)
    assert found(cable) == set()
    assert found(cable, at="tcp/127.0.0.1:7447") == {"router-of-this-machine"}


def test_variables_that_start_other_nodes_than_meant_are_found():
    cable = Interface("eth0", is_up=True, is_loopback=False, has_multicast=True)
    assert found(cable, RMW_IMPLEMENTATION="rmw_zenoh_cpp") == set()
    assert found(cable, RMW_IMPLEMENTATION="rmw_fastrtps_cpp") == {"other-rmw"}
    assert found(cable, ROS_LOCALHOST_ONLY="1") == {"settings-of-dds"}


def test_nodes_on_dds_that_are_started_here_need_a_bridge_and_it_reads_their_settings():
    variables = {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp", "ROS_LOCALHOST_ONLY": "1"}
    codes = {one.code: one for one in findings(Seen(here=Here((LOOP,), variables)))}
    assert "through zenoh-bridge-ros2dds" in codes["other-rmw"].sentence
    assert "only nodes of this machine then" in codes["settings-of-dds"].sentence


def test_this_machine_is_looked_at_without_any_address_of_it():
    here = look_here({"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp", "HOME": "/home/anna"})
    assert here.variables == {"RMW_IMPLEMENTATION": "rmw_cyclonedds_cpp"}
    assert here.interfaces
    seen = examine(Seen(here=here))
    (network,) = (one for one in seen.subjects if one.subject == "network")
    assert network.count == len(here.interfaces)
