"""What pages are told of bridges to DDS."""

from __future__ import annotations

from studio.live.connection.bridges import BRIDGES_SHOWN, bridge_views
from studio.protocol.connection import SlowedTopics
from studio.ros.wire.bridges.admin import Rules
from studio.ros.wire.bridges.bridge import Bridge
from studio.ros.wire.bridges.dialect import RouteKind
from tests.support.dds_bridges import bridge, started


def test_a_bridge_is_told_with_its_settings_and_the_number_of_its_nodes():
    (told,) = bridge_views((bridge("/r1/a", "/r1/b", name="/r1", settings=started(3, "/r1")),))
    assert (told.name, told.version, told.domain) == ("/r1", "1.10.0", 3)
    assert (told.node_count, told.hosts, told.state) == (2, ("robot",), "used")
    assert (told.rules, told.withheld, told.slowed) == ((), (), ())


def test_what_is_not_let_through_is_told_once_for_each_name_with_the_list_that_says_so():
    rules = Rules(False, {RouteKind.PUBLISHER: "^/scan$", RouteKind.SERVICE: ".*"})
    kept = [(RouteKind.SERVICE, f"/s{at}") for at in range(30)]
    twice = [(RouteKind.PUBLISHER, "/scan"), (RouteKind.SUBSCRIPTION, "/scan")]
    settings = started(rules=rules, slowed=(("/tf", 5.0),), localhost_only=True)
    (told,) = bridge_views((bridge("/a", settings=settings, withheld=(*twice, *kept)),))
    assert (told.allows, told.withheld_count, told.withheld[:2]) == (False, 31, ("/scan", "/s0"))
    assert len(told.withheld) < told.withheld_count
    assert told.rules == ("publishers: ^/scan$", "service_servers: .*")
    assert told.slowed == (SlowedTopics(topics="/tf", rate_hz=5.0),)
    assert told.localhost_only


def test_a_bridge_that_shows_nothing_is_told_with_the_reason():
    found = (
        bridge(),
        bridge(twin="/robot1"),
        bridge("/a", is_used=False),
        bridge("/a", twin="/robot1"),
    )
    states = [one.state for one in bridge_views(found)]
    assert states == ["empty", "twin", "other_domain", "used"]


def test_nodes_on_fast_dds_are_counted_for_they_answer_nothing():
    (told,) = bridge_views((bridge("/a", "/b", participant="010f33"),))
    assert (told.node_count, told.fast_dds_count) == (2, 2)
    assert bridge_views((bridge("/a"),))[0].fast_dds_count == 0


def test_a_bridge_that_tells_nothing_of_itself_is_shown_by_its_name_alone():
    nothing = Bridge("abcdef123", "bridge abcdef", "", None, (), (), (), (), True, "")
    (told,) = bridge_views((nothing,))
    assert (told.name, told.version, told.domain) == ("bridge abcdef", "", None)
    assert (told.namespace, told.localhost_only, told.allows) == ("/", False, False)


def test_of_many_bridges_the_first_are_told():
    assert len(bridge_views([bridge()] * (BRIDGES_SHOWN + 5))) == BRIDGES_SHOWN
