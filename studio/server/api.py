"""REST under `/api`: the same commands and events for scripts, described by OpenAPI."""

from http import HTTPStatus
from typing import Any, Final

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse, Response
from pydantic import BaseModel

import studio
from studio.errors import CommandError
from studio.protocol import Event
from studio.protocol.commands import COMMAND_LIMIT_BYTES
from studio.protocol.documents import Documents, Refused
from studio.protocol.roles import Role, Visitor
from studio.protocol.texts import GetUrdf, Urdf
from studio.server.answers import Answers
from studio.server.schema import COMMAND_BODY
from studio.server.surface import OpenDocuments

_STATUS: Final = {
    "NotAllowedError": HTTPStatus.FORBIDDEN,
    "UnknownDocumentError": HTTPStatus.NOT_FOUND,
    "CommandError": HTTPStatus.UNPROCESSABLE_ENTITY,
    "InternalError": HTTPStatus.INTERNAL_SERVER_ERROR,
}
"""By the kind of a refusal; every other kind is a conflict with what is open now."""
_TO_SAVE: Final = {"content-disposition": 'attachment; filename="robot.urdf"'}
_REFUSALS: Final[dict[int | str, dict[str, Any]]] = {
    status.value: {"model": Refused, "description": "Refused, and why"}
    for status in (*_STATUS.values(), HTTPStatus.CONFLICT)
}


class Health(BaseModel):
    """That the studio is there, and which one."""

    status: str = "ok"
    version: str
    session: str


class CommandAnswer(BaseModel):
    """Every event that the command brought about for its asker, in their order."""

    events: list[Event]


class Api:
    """The routes and what they need."""

    def __init__(self, engine: OpenDocuments, session: str) -> None:
        self._engine, self._session = engine, session

    def router(self) -> APIRouter:
        """All routes, with their models."""
        router = APIRouter(prefix="/api")
        router.add_api_route("/health", self.health)
        router.add_api_route("/documents", self.documents)
        router.add_api_route(
            "/documents/{document}/urdf",
            self.urdf,
            response_class=_UrdfFile,
            responses=_REFUSALS,
        )
        router.add_api_route(
            "/commands",
            self.command,
            methods=["POST"],
            response_model=CommandAnswer,
            responses=_REFUSALS,
            openapi_extra=COMMAND_BODY,
        )
        return router

    async def health(self) -> Health:
        """That the studio answers; `session` changes with every start."""
        return Health(version=studio.__version__, session=self._session)

    async def documents(self) -> Documents:
        """All open documents."""
        listener = Answers(Visitor(Role.PRESENTER))
        self._engine.attach(listener)
        self._engine.detach(listener)
        return next(event for event in listener.events if isinstance(event, Documents))

    async def urdf(self, document: str, request: Request) -> Response:
        """The expanded URDF of the last good run, as a file."""
        wish = GetUrdf(document=document).model_dump_json().encode()
        events = await Answers(_visitor(request)).collect(self._engine, wish)
        for event in events:
            if isinstance(event, Urdf):
                return _UrdfFile(event.text, headers=_TO_SAVE)
        return _refusal(events) or Response(status_code=HTTPStatus.NOT_FOUND)

    async def command(self, request: Request) -> Response:
        """Carry out one command, as the websocket would."""
        text = await _body(request)
        events = await Answers(_visitor(request)).collect(self._engine, text)
        answer = JSONResponse({"events": [event.model_dump(mode="json") for event in events]})
        return _refusal(events) or answer


class _UrdfFile(Response):
    """A URDF, whatever its text holds."""

    media_type = "application/xml"


def _visitor(request: Request) -> Visitor:
    return request.scope["state"]["visitor"]


def _refusal(events: list[Event]) -> Response | None:
    """The answer for a command that was refused."""
    for event in events:
        if isinstance(event, Refused):
            status = _STATUS.get(event.kind, HTTPStatus.CONFLICT)
            return JSONResponse(event.model_dump(mode="json"), status)
    return None


async def _body(request: Request) -> bytes:
    """The whole body, as long as it is no longer than a command may be.

    Raises:
        CommandError: It is longer.
    """
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > COMMAND_LIMIT_BYTES:
            raise CommandError(f"A command of more than {COMMAND_LIMIT_BYTES} bytes is not read.")
    return bytes(body)
