"""Whether bridges to DDS have routes for the studio's ends, and who else announces to them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.live.doctor.passing import announcing_sessions, unrouted_ends
from studio.ros.client import Node
from studio.ros.messages import message
from studio.ros.wire.bridges import passing
from studio.ros.wire.bridges.dialect import RouteKind
from tests.support.patient import STRING, Patient
from tests.support.pretend_bridge import PretendBridge
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.live.doctor.seen import Seen, System

pytestmark = pytest.mark.network
TOKEN = "MS/back/std_msgs§msg§String/:1::0,10"


@pytest.fixture
def bridge(patient: Patient) -> Generator[PretendBridge]:
    """A bridge with a node that hears /back, which the studio publishes."""
    with PretendBridge(patient.endpoint) as made:
        made.node("/driver", subscribers=[("/back", STRING)]).announce(TOKEN).show()
        studio = Node("studio", context=patient.context)
        studio.create_publisher(message(STRING), "/back", 10)
        wait_until("both ends are there", lambda: has_both(patient.seen()))
        yield made
        studio.destroy_node()
    wait_until("the bridge is gone", lambda: not system_of(patient.seen()).bridges)


def system_of(seen: Seen) -> System:
    assert seen.system is not None
    return seen.system


def has_both(seen: Seen) -> bool:
    ends = system_of(seen).topics.get("/back")
    return bool(ends and ends.senders and any(one.node.bridge for one in ends.receivers))


def test_a_route_that_a_bridge_has_is_not_missed(patient: Patient, bridge: PretendBridge):
    wire = patient.context.wire
    bridge.told["route/topic/sub/back"] = {"is_active": True, "remote_routes": [f"{wire.zid}:back"]}
    assert unrouted_ends(wire, system_of(patient.seen())) == ()
    assert "no-route" not in patient.codes("/back", asks=True)


def test_a_route_that_does_not_come_is_missed(
    patient: Patient, bridge: PretendBridge, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(passing, "_ON_ITS_WAY_S", 0.01)
    bridge.told["route/topic/sub/back"] = {"is_active": False, "remote_routes": []}
    (one,) = unrouted_ends(patient.context.wire, system_of(patient.seen()))
    assert (one.kind, one.name) == (RouteKind.PUBLISHER, "/back")
    assert (one.own.node.path, one.other.node.path) == ("/studio", "/driver")
    found = patient.until("no-route", "/back", asks=True)
    assert "nothing comes through" in found.sentence


def test_of_a_bridge_that_does_not_answer_nothing_is_concluded(
    patient: Patient, bridge: PretendBridge, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(passing, "_ON_ITS_WAY_S", 0.01)
    system = system_of(patient.seen())
    bridge.told.clear()
    assert unrouted_ends(patient.context.wire, system) == ()


def test_sessions_that_announce_to_bridges_are_known(patient: Patient, bridge: PretendBridge):
    found = announcing_sessions(patient.context.wire)
    wait_until(
        "the robot's node of the studio's library announces, too",
        lambda: patient.robot.wire.zid in announcing_sessions(patient.context.wire),
    )
    assert bridge.zid in found
