"""Bridges to DDS: those that are no use, keep names back, or show a robot twice."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Ends, Unrouted
from studio.ros.graph.endpoints import GraphEndpoint, GraphNode
from studio.ros.qos import DurabilityPolicy, QoSProfile
from studio.ros.tokens import EndpointKind
from studio.ros.wire.bridges.admin import Rules
from studio.ros.wire.bridges.dialect import RouteKind
from tests.support.dds_bridges import bridge, bridged_end, started
from tests.support.patient import STRING

if TYPE_CHECKING:
    from studio.live.doctor.seen import Seen
    from studio.protocol.doctor import Finding
    from studio.ros.wire.bridges.bridge import Bridge
    from tests.support.patient import Patient

pytestmark = pytest.mark.network
SCAN = (RouteKind.PUBLISHER, "/scan")


def found(patient: Patient, *bridges: Bridge) -> dict[str, Finding]:
    """What is found with some bridges, by code."""
    return {one.code: one for one in examine(with_bridges(patient.seen(), *bridges)).findings}


def with_bridges(seen: Seen, *bridges: Bridge) -> Seen:
    assert seen.system is not None
    return replace(seen, system=replace(seen.system, bridges=bridges))


def test_without_bridges_nothing_is_said(patient: Patient):
    (view,) = (one for one in patient.examined().subjects if one.subject == "bridges")
    assert (view.state, view.count) == ("well", 0)


def test_bridges_are_said_with_version_domain_and_nodes(patient: Patient):
    seen = with_bridges(patient.seen(), bridge("/driver", "/laser"))
    (view,) = (one for one in examine(seen).subjects if one.subject == "bridges")
    assert (view.state, view.count) == ("well", 1)
    assert view.detail == "robot 1.10.0, domain 0, 2 nodes"


def test_a_bridge_of_another_domain_can_be_followed_there(patient: Patient):
    one = bridge("/driver", settings=started(5), is_used=False)
    domain = found(patient, one)["bridge-domain"]
    assert domain.level == "note"  # for there are nodes in the studio's own
    assert "choose domain 5" in domain.sentence
    assert domain.mend is not None
    assert domain.mend.command == {"type": "connect_wire", "domain": 5}
    assert domain.evidence[1] == "its nodes: /driver"
    assert "bridge-empty" not in found(patient, one)


def elsewhere() -> Bridge:
    """A bridge of domain 5 with a node that takes velocities, settings, and goals."""
    taken = (
        bridged_end("/cmd_vel", kind=EndpointKind.SUBSCRIPTION),
        bridged_end("/parameter_events", kind=EndpointKind.SUBSCRIPTION),
        bridged_end("/driver/set_parameters", kind=EndpointKind.SERVICE),
        bridged_end("/dock/_action/send_goal", kind=EndpointKind.SERVICE),
        bridged_end("/dock/_action/cancel_goal", kind=EndpointKind.SERVICE),
        bridged_end("/scan"),
    )
    one = bridge("/driver", name="other", ends=taken, settings=started(5), is_used=False)
    return replace(one, zid="b1b1b1")


def test_a_robot_of_another_domain_that_hears_what_is_meant_for_this_one_is_a_warning(
    patient: Patient,
):
    both = elsewhere().ends
    domain = found(patient, bridge("/driver", ends=both), elsewhere())["bridge-domain"]
    assert (domain.level, domain.mend) == ("warn", None)
    assert "what is sent here to /dock, /cmd_vel, /driver/set_parameters reaches" in domain.sentence
    assert domain.evidence == (
        "it was started for domain 5",
        "action servers: /dock",
        "subscriptions: /cmd_vel",
        "services: /driver/set_parameters",
    )
    assert domain.line == "zenoh-bridge-ros2dds -d 5 -n /NAME"
    kinds = {(one.kind, one.name) for one in domain.about}
    assert kinds >= {("topic", "/cmd_vel"), ("action", "/dock")}


def test_it_hears_what_the_studio_publishes_only_beside_a_bridge_of_this_domain(patient: Patient):
    patient.publisher(STRING, "/cmd_vel")

    def level(*bridges: Bridge, own: str = "") -> str:
        seen = with_bridges(patient.seen(), *bridges)
        assert seen.system is not None
        mine = replace(seen, system=replace(seen.system, own=frozenset({own})))
        (one,) = (one for one in examine(mine).findings if one.code == "bridge-domain")
        return "sent here" if "sent here to /cmd_vel reaches" in one.sentence else one.level

    studio, used = patient.robot.wire.zid, bridge("/arm")
    assert level(used, elsewhere(), own=studio) == "sent here"
    assert level(used, elsewhere()) == "note"
    assert level(elsewhere()) == "note"


def test_bridges_of_two_domains_with_namespaces_do_not_share_a_name(patient: Patient):
    mine = bridge("/driver", ends=(bridged_end("/robot1/cmd_vel"),))
    assert found(patient, mine, elsewhere())["bridge-domain"].level == "note"


@pytest.mark.parametrize("is_here_only", [True, False])
def test_a_bridge_without_a_node_is_a_warning_that_says_where_it_looks(
    patient: Patient, *, is_here_only: bool
):
    one = bridge(settings=started(localhost_only=is_here_only))
    empty = found(patient, one)["bridge-empty"]
    assert empty.level == "warn"
    assert ("--ros-localhost-only" in empty.sentence) is is_here_only
    assert ("multicast" in empty.sentence) is not is_here_only
    assert empty.line == "ROS_DOMAIN_ID=0 ros2 node list --no-daemon"


def test_a_bridge_that_tells_nothing_is_a_warning(patient: Patient):
    one = replace(bridge(name="bridge b0b0b0"), settings=None, version="")
    codes = found(patient, one)
    assert codes["bridge-silent"].sentence.startswith("The bridge b0b0b0 tells nothing")
    assert "bridge-empty" not in codes


def test_a_bridge_that_answers_no_more_is_dead_and_its_nodes_are_not(patient: Patient):
    seen = with_bridges(patient.seen(asks=True), bridge("/driver"))
    assert seen.answers is not None
    lost = replace(seen, answers=replace(seen.answers, lost=frozenset({"b0b0b0"})))
    codes = {one.code for one in examine(lost).findings}
    assert "dead-bridge" in codes
    assert "dead-node" not in codes


def test_what_a_list_keeps_back_is_a_note_with_that_list(patient: Patient):
    rules = Rules(allows=True, patterns={RouteKind.PUBLISHER: "^/tf$"})
    one = bridge("/driver", settings=started(rules=rules), withheld=(SCAN,))
    kept = found(patient, one)["bridge-withholds"]
    assert kept.level == "note"
    assert kept.evidence == ("allow: publishers: ^/tf$", "publishers: /scan")
    assert ("topic", "/scan") in {(about.kind, about.name) for about in kept.about}


def test_it_is_a_warning_where_the_studio_waits_for_it(patient: Patient):
    rules = Rules(allows=False, patterns={RouteKind.PUBLISHER: "^/scan$"})
    one = bridge("/driver", settings=started(rules=rules), withheld=(SCAN,))
    patient.subscribe(STRING, "/scan")
    seen = with_bridges(patient.seen(), one)
    assert seen.system is not None
    mine = replace(seen, system=replace(seen.system, own=frozenset({patient.robot.wire.zid})))
    (kept,) = (one for one in examine(mine).findings if one.code == "bridge-withholds")
    assert kept.level == "warn"
    assert "The studio waits for /scan." in kept.sentence


def test_what_no_list_keeps_back_is_said_otherwise(patient: Patient):
    rules = Rules(allows=False, patterns={RouteKind.SUBSCRIPTION: "^/cmd_vel$"})
    for settings in (started(), started(rules=rules)):
        codes = found(patient, bridge("/driver", settings=settings, withheld=(SCAN,)))
        assert codes["bridge-unrouted"].evidence == ("publishers: /scan",)
        assert "bridge-withholds" not in codes


def test_that_every_node_has_a_log_is_not_worth_saying(patient: Patient):
    one = bridge("/driver", withheld=((RouteKind.PUBLISHER, "/rosout"),))
    assert not {"bridge-unrouted", "bridge-withholds"} & found(patient, one).keys()


def test_slowed_topics_are_a_note(patient: Patient):
    one = bridge("/driver", settings=started(slowed=(("/image.*", 5.0),)))
    slows = found(patient, one)["bridge-slows"]
    assert (slows.level, slows.evidence) == ("note", ("pub_max_frequencies: /image.*=5",))


@pytest.mark.parametrize(
    ("version", "code"),
    [
        ("1.5.0", "bridge-old"),
        ("1.5.1", "bridge-version"),
        ("", "bridge-version"),
        ("1.10.0", ""),
        ("1.99.0", ""),
    ],
)
def test_the_version_of_a_bridge_is_compared(patient: Patient, version: str, code: str):
    codes = found(patient, replace(bridge("/driver"), version=version))
    assert {"bridge-old", "bridge-version"} & codes.keys() == ({code} if code else set())
    assert all(codes[one].level == "note" for one in {code} - {""})


def test_an_old_bridge_is_a_warning_where_something_is_sent_only_once(patient: Patient):
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    one = bridge("/driver", ends=(bridged_end("/map", qos=latched),))
    old = found(patient, replace(one, version="1.4.0"))["bridge-old"]
    assert (old.level, "(/map)" in old.sentence) == ("warn", True)


def test_two_bridges_to_one_robot_are_an_error(patient: Patient):
    twin = replace(bridge(twin="robot"), zid="b1b1b1")
    codes = found(patient, bridge("/driver"), twin)
    assert codes["two-bridges"].level == "error"
    assert "can go round without end" in codes["two-bridges"].sentence
    assert "bridge-empty" not in codes
    assert "shared-domain" not in codes


def test_a_robot_under_two_namespaces_is_found(patient: Patient):
    mine = bridge("/robot1/driver", name="/robot1", settings=started(0, "/robot1"))
    yours = bridge("/robot2/driver", name="/robot2", settings=started(0, "/robot2"))
    shared = found(patient, mine, replace(yours, zid="b1b1b1"))["shared-domain"]
    assert "/robot1/driver, /robot2/driver" in shared.sentence
    assert "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST (Iron" in shared.sentence
    assert shared.line == "zenoh-bridge-ros2dds -n /robot1 --ros-localhost-only"


def test_a_line_to_type_holds_nothing_that_a_machine_is_named(patient: Patient):
    mine = bridge("/driver", name="$(reboot)", settings=started(0, "/"))
    yours = bridge("/robot2/driver", name="/robot2", settings=started(0, "/robot2"))
    shared = found(patient, mine, replace(yours, zid="b1b1b1"))["shared-domain"]
    assert shared.line == "zenoh-bridge-ros2dds -n /robot2 --ros-localhost-only"


def test_nodes_on_fast_dds_bring_topics_only(patient: Patient):
    fast = bridge("/driver", participant="010f44b0ab51eec401000000000001c1")
    one = found(patient, fast)["fast-dds"]
    assert (one.level, one.line) == ("warn", "export RMW_IMPLEMENTATION=rmw_cyclonedds_cpp")
    assert "fast-dds" not in found(patient, bridge("/driver"))


def end(kind: EndpointKind, node: GraphNode, token: str) -> GraphEndpoint:
    return GraphEndpoint(token, node, kind, "/chatter", STRING, "", QoSProfile(depth=10))


DDS = GraphNode("b0b0b0", 1, "/", "driver", "/", "/driver", "robot")
ZENOH = GraphNode("c0c0c0", 1, "/", "listener", "/", "/listener")


def test_nodes_that_a_bridge_does_not_bring_together_are_found(patient: Patient):
    seen = with_bridges(patient.seen(asks=True), bridge("/driver"))
    assert seen.system is not None
    assert seen.answers is not None
    out = end(EndpointKind.PUBLISHER, DDS, "out")
    into = end(EndpointKind.SUBSCRIPTION, ZENOH, "in")
    system, answers = (
        replace(seen.system, topics={"/chatter": Ends((out,), (into,))}),
        seen.answers,
    )

    def codes(announcing: frozenset[str], own: frozenset[str]) -> dict[str, Finding]:
        told = replace(answers, announcing=announcing)
        now = replace(seen, system=replace(system, own=own), answers=told)
        return {one.code: one for one in examine(now).findings}

    apart = codes(frozenset(), frozenset())["two-worlds"]
    assert apart.evidence == ("/chatter: /driver to /listener, /driver is on DDS",)
    assert "two-worlds" not in codes(frozenset({"c0c0c0"}), frozenset())
    assert "two-worlds" not in codes(frozenset(), frozenset({"c0c0c0"}))


def test_a_route_that_is_missing_is_an_error_as_long_as_both_ends_are_there(patient: Patient):
    seen = with_bridges(patient.seen(asks=True), bridge("/driver"))
    assert seen.system is not None
    assert seen.answers is not None
    out = end(EndpointKind.PUBLISHER, ZENOH, "out")
    into = end(EndpointKind.SUBSCRIPTION, DDS, "in")
    missing = Unrouted(out, into, RouteKind.PUBLISHER, "/chatter")
    answers = replace(seen.answers, unrouted=(missing,))
    mine = replace(seen.system, own=frozenset({"c0c0c0"}))

    def codes(*senders: GraphEndpoint) -> dict[str, Finding]:
        system = replace(mine, topics={"/chatter": Ends(senders, (into,))})
        now = replace(seen, system=system, answers=answers)
        return {one.code: one for one in examine(now).findings}

    route = codes(out)["no-route"]
    assert route.level == "error"
    assert "which the studio publishes and /driver subscribes to" in route.sentence
    assert "no-route" not in codes()
