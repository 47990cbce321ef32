"""A bridge to DDS that is only a Zenoh session: it shows, tells and sends whatever a test says."""

from __future__ import annotations

import json
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Self, cast

from studio.ros.wire.zenoh import close, declare_token
from tests.support.dds_bridge import session_at

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.ros.wire.zenoh import Declaration

PARTICIPANT = "0110148101bf2c19a5072d13000001c1"
CONFIG = {"domain": 0, "namespace": "/", "nodename": "zenoh_bridge_ros2dds"}


class PretendBridge:
    """A session at a router; close it, or use `with`.

    Attributes:
        zid: Its id, as tokens carry it.
        told: What its admin space answers, by what follows `@/ZID/ros2/`.
    """

    def __init__(self, endpoint: str, config: dict[str, Any] | None = None) -> None:
        self.session = session_at(endpoint)
        self.zid = str(self.session.info.zid())
        self.told: dict[str, object] = {
            "version": "v1.10.0",
            "config": {**CONFIG, **(config or {})},
        }
        self._declared: dict[str, Declaration] = {}
        self._servers: list[object] = []
        self.serve(f"@/{self.zid}/ros2/**", self._tell)

    def show(self) -> Self:
        """Show that it is a bridge."""
        return self.announce("")

    def announce(self, rest: str) -> Self:
        """Show a token, by what follows `@/ZID/@ros2_lv/`."""
        token = f"@/{self.zid}/@ros2_lv" + (f"/{rest}" if rest else "")
        self._declared[rest] = declare_token(self.session, token)
        return self

    def retire(self, rest: str) -> None:
        """Show a token no more."""
        self._declared.pop(rest).undeclare()

    def node(
        self, path: str, participant: str = PARTICIPANT, **lists: list[tuple[str, str]]
    ) -> Self:
        """Tell of a node; lists are named as the bridge's are, `publishers` and so on."""
        words = (
            "publishers", "subscribers", "service_servers", "service_clients", "action_servers",
            "action_clients",
        )  # fmt: skip
        self.told[f"node/{participant}{path}"] = {
            word: [{"name": name, "type": kind} for name, kind in lists.get(word, [])]
            for word in words
        }
        return self

    def send(self, key: str, cdr: bytes) -> None:
        """Send a sample, stamped by this session as a bridge does."""
        session = cast("Any", self.session)
        session.put(key, cdr, timestamp=session.new_timestamp())

    def copy(self, key: str, cdr: bytes) -> None:
        """Send a sample as a node of rmw_zenoh sends it to bridges, which has sent it before."""
        cast("Any", self.session).put(key, cdr, attachment=bytes(33))

    def serve(self, key: str, answer: Callable[[Any], object]) -> None:
        """Call back with each query of a key."""
        self._servers.append(cast("Any", self.session).declare_queryable(key, answer))

    def _tell(self, query: Any) -> None:  # noqa: ANN401
        for rest, value in dict(self.told).items():
            key = f"@/{self.zid}/ros2/{rest}"
            if not query.key_expr.intersects(key):
                continue
            payload = value if isinstance(value, bytes) else json.dumps(value).encode()
            query.reply(key, payload)

    def close(self) -> None:
        """End the session, as a killed bridge does."""
        close(self.session)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


@contextmanager
def talking_bridge(endpoint: str, **config: object) -> Generator[PretendBridge]:
    """A bridge with a node /talker that publishes /chatter."""
    with PretendBridge(endpoint, config) as bridge:
        bridge.node("/talker", publishers=[("/chatter", "std_msgs/msg/String")])
        bridge.announce("MP/chatter/std_msgs§msg§String/:1::0,10").show()
        yield bridge
