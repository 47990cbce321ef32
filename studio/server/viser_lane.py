"""The 3D lane: viser's own websocket, one per document."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.scene import SUBPROTOCOL
from studio.server.access import may
from studio.server.lane import Lane

if TYPE_CHECKING:
    from starlette.websockets import WebSocket

    from studio.protocol.roles import Visitor
    from studio.server.surface import OpenScene


async def serve_scene(
    websocket: WebSocket, scene: OpenScene, visitor: Visitor, document: str
) -> None:
    """Speak viser's protocol until the browser leaves or the document is closed."""
    offered: list[str] = websocket.scope["subprotocols"]
    # A page of another version is let in all the same: only so does it hear why it must leave.
    spoken = SUBPROTOCOL if SUBPROTOCOL in offered else next(iter(offered), None)
    await websocket.accept(subprotocol=spoken)
    lane = Lane(websocket)
    await scene.serve(lane, lambda message: may(visitor, f"viser:{message}", document), spoken)
    await lane.finish()
