"""The application: every route of the one port, behind the guard."""

from collections.abc import Callable
from http import HTTPStatus
from typing import Any, Final

from fastapi import Depends, FastAPI
from starlette.exceptions import HTTPException
from starlette.requests import HTTPConnection, Request
from starlette.responses import JSONResponse, Response
from starlette.types import ASGIApp
from starlette.websockets import WebSocket

import studio
from studio.errors import AccessError, CommandError, StudioError, UnknownDocumentError
from studio.protocol.commands import demand
from studio.server.access import PUBLIC_ROUTES, ROUTES
from studio.server.api import Api, Exports, HandedIn, LogOut, WrittenBags
from studio.server.assets import Assets
from studio.server.cookies import Cookies
from studio.server.credentials import Credentials
from studio.server.front import Front
from studio.server.guard import Guard
from studio.server.joining import Joining
from studio.server.pages import not_found_page, trouble_page
from studio.server.schema import openapi
from studio.server.site import Site
from studio.server.surface import OpenDocuments
from studio.server.uploads import Uploads

_STATUS: Final = (
    (AccessError, HTTPStatus.FORBIDDEN),
    (UnknownDocumentError, HTTPStatus.NOT_FOUND),
    (CommandError, HTTPStatus.UNPROCESSABLE_ENTITY),
    (StudioError, HTTPStatus.CONFLICT),
)


def make_app(
    engine: OpenDocuments,
    assets: Assets,
    credentials: Credentials,
    session: str,
    front: Front,
    neighbours: Callable[[], tuple[str, ...]] | None = None,
) -> ASGIApp:
    """Return the whole application, which is reached at `front`.

    The caller starts and closes the engine. With `neighbours`, addresses of other relays, it is
    served by a relay, and takes their passes.
    """
    app = FastAPI(
        title="Robot description studio",
        version=studio.__version__,
        openapi_url=None,  # FastAPI's own route would stand beside the door
        docs_url=None,  # its pages load scripts from a public host
        redoc_url=None,
        redirect_slashes=False,
        dependencies=[Depends(check_role)],
    )
    app.state.root = front.base
    app.add_exception_handler(StudioError, _answer_error)
    app.add_exception_handler(HTTPException, _answer_http_error)
    classroom = engine.classroom
    cookies = Cookies(credentials, classroom, front, takes_passes=neighbours is not None)
    Site(engine, assets, session, front.base, neighbours).add_to(app)
    app.include_router(Api(engine, session).router())
    app.include_router(Exports(engine).router())
    app.include_router(HandedIn(engine).router())
    app.include_router(WrittenBags(engine).router())
    app.include_router(Uploads(engine).router())
    app.include_router(LogOut(credentials, classroom).router())
    app.include_router(Joining(classroom, cookies, front, assets.words).router())
    document = openapi(app.routes)

    async def openapi_document() -> dict[str, Any]:
        return document

    app.add_api_route("/api/openapi.json", openapi_document, include_in_schema=False)
    return Guard(app, front, credentials, cookies, lambda: classroom.admission.open)


def check_role(connection: HTTPConnection) -> None:
    """Ask `may` for every route; nobody may use one that is in no table.

    Raises:
        NotAllowedError: The caller's role may not use this route.
    """
    path = connection.scope["route"].path
    if path not in PUBLIC_ROUTES:
        document = connection.path_params.get("document", "")
        demand(connection.scope["state"]["visitor"], ROUTES.get(path), document)


async def _answer_error(connection: Request | WebSocket, error: Exception) -> Response:
    """Return an error of the studio in one sentence; a websocket is not opened then."""
    status = next(status for kind, status in _STATUS if isinstance(error, kind))
    if isinstance(connection, WebSocket):
        return _plain(error, status)
    if _wants_page(connection):
        missing = status is HTTPStatus.NOT_FOUND
        root = connection.app.state.root
        return not_found_page(root) if missing else trouble_page(str(error), status, root)
    return _plain(error, status)


async def _answer_http_error(request: Request | WebSocket, error: Exception) -> Response:
    """Answer for the router's own errors: no such address, no such method."""
    assert isinstance(error, HTTPException)
    if _wants_page(request) and error.status_code == HTTPStatus.NOT_FOUND:
        return not_found_page(request.app.state.root)
    return JSONResponse({"kind": "HttpError", "reason": error.detail}, error.status_code)


def _plain(error: Exception, status: HTTPStatus) -> Response:
    return JSONResponse({"kind": type(error).__name__, "reason": str(error)}, status)


def _wants_page(connection: HTTPConnection) -> bool:
    return not connection.url.path.startswith("/api/") and (
        "text/html" in connection.headers.get("accept", "")
    )
