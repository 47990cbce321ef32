"""Endpoint: what a publisher, subscription, service and client of a node have in common."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.tokens import DataKey, gid_of
from studio.ros.wire.zenoh import declare_token

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.graph.graph import Graph
    from studio.ros.tokens import EndpointToken
    from studio.ros.wire.session import WireSession
    from studio.ros.wire.zenoh import Declaration


class Endpoint:
    """A token on the wire and the key it stands for.

    Attributes:
        token: As it is shown to all.
        gid: The 16 bytes that name it in every sample.
        key: The data key.
        graph: Gives who is there.
    """

    def __init__(self, wire: WireSession, token: EndpointToken, graph: Callable[[], Graph]) -> None:
        self.wire, self.graph = wire, graph
        self.token = token
        self.gid = gid_of(str(token))
        self.key = str(DataKey(wire.domain, token.name, token.type_name, token.type_hash))
        self._shown: Declaration | None = None

    def show(self) -> None:
        """Show the token, after what it stands for was declared."""
        self._shown = declare_token(self.wire.zenoh, str(self.token))

    def hide(self, *declared: Declaration) -> None:
        """Take back the token, then what it stands for; nothing when the session is closed."""
        shown, self._shown = self._shown, None
        if shown is None or self.wire.zenoh.is_closed():
            return
        for one in (shown, *declared):
            one.undeclare()
