"""Routes that a session announced and bridges do not have, where sessions stand for bridges."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any, NamedTuple

import pytest

from studio.ros.wire.bridges import passing
from studio.ros.wire.bridges.dialect import RouteKind
from studio.ros.wire.bridges.passing import missing_routes
from tests.support.pretend_bridge import PretendBridge
from tests.support.wire import open_test_session, running_router, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.wire.session import WireSession

pytestmark = pytest.mark.network
BACK, ADD = (RouteKind.PUBLISHER, "/back"), (RouteKind.CLIENT, "/add")


class Met(NamedTuple):
    """A session, and a bridge that answers it."""

    wire: WireSession
    bridge: PretendBridge

    def missing(self, *zids: str) -> dict[str, list[tuple[RouteKind, str]]]:
        """What of a publisher and a client bridges have no route for."""
        return missing_routes(self.wire.zenoh, dict.fromkeys(zids, (BACK, ADD)))


@pytest.fixture
def met(monkeypatch: pytest.MonkeyPatch) -> Generator[Met]:
    monkeypatch.setattr(passing, "_ON_ITS_WAY_S", 0.01)
    with (
        running_router() as endpoint,
        open_test_session(endpoint) as wire,
        PretendBridge(endpoint) as bridge,
    ):
        bridge.show()
        wait_until("the bridge answers", lambda: bool(wire.bridges.current))
        yield Met(wire, bridge)


def test_what_has_no_route_is_missing_and_what_has_one_is_not(met: Met):
    served = [f"{met.wire.zid}:back"]
    met.bridge.told["route/topic/sub/back"] = {"is_active": True, "remote_routes": served}
    met.bridge.told["route/service/srv/add"] = {"is_active": True, "remote_routes": ["other:add"]}
    assert met.missing(met.bridge.zid) == {met.bridge.zid: [ADD]}


def test_a_route_that_is_on_its_way_is_waited_for(met: Met):
    looks: list[None] = []

    def answer(query: Any) -> None:  # noqa: ANN401
        if not str(query.key_expr).endswith("/route/**"):
            return
        for path, name in (("topic/sub/back", "back"), ("service/srv/add", "add")):
            route = {"is_active": bool(looks), "remote_routes": [f"{met.wire.zid}:{name}"]}
            query.reply(f"@/{met.bridge.zid}/ros2/route/{path}", json.dumps(route).encode())
        looks.append(None)

    met.bridge.serve(f"@/{met.bridge.zid}/ros2/route/**", answer)
    assert met.missing(met.bridge.zid) == {}
    assert len(looks) == 2


def test_of_a_bridge_that_tells_no_route_nothing_is_known(met: Met):
    assert met.missing(met.bridge.zid, "abc") == {}
