"""Logging out: all cookies end, those of viewers too; the printed addresses still lead in."""

from http import HTTPStatus

from fastapi import APIRouter, Request
from starlette.background import BackgroundTask
from starlette.responses import PlainTextResponse, Response

from studio.server.credentials import Credentials
from studio.server.http_protocol import connection_of

_NO_TOKEN = "This studio asks nobody for a token (--no-token): there is nobody to log out."


class LogOut:
    """The route, and the credentials that it revokes."""

    def __init__(self, credentials: Credentials) -> None:
        self._credentials = credentials

    def router(self) -> APIRouter:
        """The one route."""
        router = APIRouter(prefix="/api")
        router.add_api_route(
            "/log-out",
            self.everybody,
            methods=["POST"],
            status_code=HTTPStatus.NO_CONTENT,
            response_class=Response,
        )
        return router

    async def everybody(self, request: Request) -> Response:
        """Make every cookie invalid that was ever given, and end what is open with one."""
        if self._credentials.token is None:
            return PlainTextResponse(_NO_TOKEN, HTTPStatus.CONFLICT)
        self._credentials.revoke()
        ending = BackgroundTask(_end_all, request)
        return Response(status_code=HTTPStatus.NO_CONTENT, background=ending)


async def _end_all(request: Request) -> None:
    connection_of(request.scope).end_all()
