"""The routes that a browser uses: the page, its files, the 3D view's page, the websockets."""

import asyncio
from collections.abc import Callable
from functools import lru_cache
from http import HTTPStatus
from typing import Final

from fastapi import FastAPI
from starlette.requests import Request
from starlette.responses import RedirectResponse, Response
from starlette.websockets import WebSocket

import studio
from studio.protocol.commands import may
from studio.protocol.documents import Hello
from studio.protocol.roles import Person, owner_of
from studio.scene import SUBPROTOCOL, viser_page
from studio.server.access import VISER
from studio.server.assets import Asset, Assets, Tree, accepted_coding
from studio.server.bulk_lane import BulkAnswer, BulkKeys
from studio.server.commands import ControlLane
from studio.server.data_lane import DataLane
from studio.server.guard import HEALTH_PATH
from studio.server.pages import studio_page
from studio.server.policy import SCENE_POLICY, WORKER_POLICY, probe_policy
from studio.server.ports import FULL_SCREEN
from studio.server.surface import OpenDocuments, OpenScene
from studio.server.websocket import Lane

_LOOK_EVERY_S: Final = 1.0


async def serve_scene(
    websocket: WebSocket, scene: OpenScene, visitor: Person, document: str
) -> None:
    """Speak viser's protocol until the browser leaves or the document is closed."""
    offered: list[str] = websocket.scope["subprotocols"]
    # A page of another version is accepted as well: else it would not learn why it must reload.
    spoken = SUBPROTOCOL if SUBPROTOCOL in offered else next(iter(offered), None)
    await websocket.accept(subprotocol=spoken)
    lane = Lane(websocket)
    watching = None
    if owner_of(document):
        watching = asyncio.create_task(_end_with_sight(lane, visitor, document))
    try:
        await scene.serve(lane, lambda message: may(visitor, VISER.get(message), document), spoken)
    finally:
        if watching is not None:
            watching.cancel()
    await lane.finish()


async def _end_with_sight(lane: Lane, visitor: Person, copy: str) -> None:
    """Close the lane once its person may not look at a copy any more."""
    while visitor.sees(copy):  # noqa: ASYNC110 - nobody tells it
        await asyncio.sleep(_LOOK_EVERY_S)
    lane.close()


_FOREVER: Final = "public, max-age=31536000, immutable"
_ICON: Final = "styles/logo.svg"
_WORKERS: Final = "workers/"
_PROBE: Final = "workers/probe.js"
_SCENE_SCRIPT: Final = "viser/studio3d.js"


class Site:
    """The routes and what they need.

    Args:
        engine: What is open.
        assets: The files of the page.
        session: Changes with every start.
        base: The path below which the studio is reached.
        neighbours: Addresses at which people can go on when this server, a relay, is gone; None:
            it is no relay.
    """

    def __init__(
        self,
        engine: OpenDocuments,
        assets: Assets,
        session: str,
        base: str,
        neighbours: Callable[[], tuple[str, ...]] | None = None,
    ) -> None:
        self._engine, self._assets, self._session = engine, assets, session
        self._base, self._neighbours = base, neighbours
        self._bulk_keys = BulkKeys()

    def add_to(self, app: FastAPI) -> None:
        """Add every route; none of them is for scripts, so none is in the OpenAPI document."""
        pages = (
            ("/", self.home),
            ("/d/{document}", self.page),
            ("/d/{document}/viser/", self.scene_page),
            ("/a/{tree}/{path:path}", self.asset),
            ("/favicon.ico", self.icon),
        )
        for path, endpoint in pages:
            app.add_api_route(
                path,
                endpoint,
                methods=["GET", "HEAD"],
                include_in_schema=False,
                response_class=Response,
                response_model=None,
            )
        if self._neighbours is not None:
            app.add_api_route(HEALTH_PATH, self.health, include_in_schema=False)
        app.add_api_route(
            "/bulk",
            self.bulk,
            include_in_schema=False,
            response_class=Response,
            response_model=None,
        )
        app.add_api_websocket_route("/control", self.control)
        app.add_api_websocket_route("/data", self.data)
        app.add_api_websocket_route("/d/{document}/viser", self.scene)

    async def home(self, request: Request) -> Response:
        """Redirect to the default document; serve the page itself while there is none."""
        document = self._engine.default_document
        if document is None:
            return studio_page(self._assets.current(), self._base)
        name, _, value = FULL_SCREEN.partition("=")
        more = f"?{FULL_SCREEN}" if request.query_params.get(name) == value else ""
        return RedirectResponse(f"{self._base}/d/{document}{more}", HTTPStatus.SEE_OTHER)

    async def page(self, document: str) -> Response:
        """Return the studio's page for one document."""
        self._engine.check(document)
        return studio_page(self._assets.current(), self._base)

    async def scene_page(self, document: str, request: Request) -> Response:
        """Return viser's page, to be shown inside ours; another version would be refused."""
        self._engine.check(document)
        answer = _send(_scene_page(self._assets.current(), self._base), request, "no-store")
        answer.headers["content-security-policy"] = SCENE_POLICY
        return answer

    async def asset(self, tree: str, path: str, request: Request) -> Response:
        """Return one file of the page, if it was found below its folder."""
        found = self._assets.find(tree, path)
        if found is None:
            return Response(status_code=HTTPStatus.NOT_FOUND)
        asset, is_exact = found
        is_probe = path == _PROBE and self._neighbours is not None
        # A page begins the probe anew when its neighbours change, and needs the policy of then.
        answer = _send(asset, request, _FOREVER if is_exact and not is_probe else "no-store")
        if self._neighbours is not None and is_probe:
            answer.headers["content-security-policy"] = probe_policy(self._neighbours())
        elif path.startswith(_WORKERS):
            answer.headers["content-security-policy"] = WORKER_POLICY
        return answer

    async def health(self) -> Response:
        """Return nothing; that an answer came is for the pages of other relays, too."""
        headers = {"cross-origin-resource-policy": "cross-origin"}
        return Response(status_code=HTTPStatus.NO_CONTENT, headers=headers)

    async def icon(self, request: Request) -> Response:
        """Return the icon, for browsers that ask without a link to it."""
        asset = self._assets.current().files.get(_ICON)
        if asset is None:
            return Response(status_code=HTTPStatus.NO_CONTENT)
        return _send(asset, request, "max-age=3600")

    async def control(self, websocket: WebSocket) -> None:
        """The control lane."""
        await websocket.accept()
        visitor: Person = websocket.scope["state"]["visitor"]
        hello = Hello(role=visitor.role.value, version=studio.__version__, session=self._session)
        await ControlLane(Lane(websocket), visitor).serve(self._engine, hello)

    async def data(self, websocket: WebSocket) -> None:
        """The data lane."""
        await websocket.accept()
        visitor: Person = websocket.scope["state"]["visitor"]
        lane = DataLane(Lane(websocket), self._bulk_keys, visitor)
        await lane.serve(self._engine.browser_topics)

    async def bulk(self, key: str = "") -> Response:
        """Open the bulk lane of the data lane with this key."""
        return BulkAnswer(self._bulk_keys.lane_of(key))

    async def scene(self, document: str, websocket: WebSocket) -> None:
        """The 3D lane of one document."""
        scene = (await self._engine.ready(document)).scene
        await serve_scene(websocket, scene, websocket.scope["state"]["visitor"], document)


@lru_cache(maxsize=2)
def _scene_page(tree: Tree, root: str) -> Asset:
    """Viser's page with the modules of ours that it begins with."""
    base = root + tree.base
    page = viser_page(base.rstrip("/"), tree.preloads([_SCENE_SCRIPT], base))
    return Asset(page, "text/html; charset=utf-8")


def _send(asset: Asset, request: Request, caching: str) -> Response:
    """Return the file, compressed where the browser takes it."""
    headers = {"content-type": asset.type, "cache-control": caching, "vary": "accept-encoding"}
    coding = accepted_coding(request.headers.get("accept-encoding", ""))
    packed = asset.packed(coding) if coding else None
    if packed is None:
        return Response(asset.content, headers=headers)
    return Response(packed, headers=headers | {"content-encoding": str(coding)})
