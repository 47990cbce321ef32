"""The routes for scripts: documents, commands, downloads, and logging everybody out."""

import asyncio
from collections.abc import Sequence
from http import HTTPStatus
from pathlib import Path
from typing import Annotated, Any, Final, Literal, Protocol
from urllib.parse import quote

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel
from starlette.background import BackgroundTask
from starlette.responses import FileResponse, JSONResponse, Response, StreamingResponse

import studio
from studio.documents.exports import Download
from studio.errors import BagNotReadableError, CommandError
from studio.files import is_file
from studio.protocol import Event
from studio.protocol.commands import COMMAND_LIMIT_BYTES
from studio.protocol.documents import Documents, Refused
from studio.protocol.roles import Person
from studio.protocol.texts import GetUrdf, Urdf
from studio.server.commands import Answers
from studio.server.credentials import Credentials
from studio.server.http_protocol import connection_of
from studio.server.schema import COMMAND_BODY
from studio.server.surface import OpenDocuments

_STATUS: Final = {
    "NotAllowedError": HTTPStatus.FORBIDDEN,
    "NotInControlError": HTTPStatus.FORBIDDEN,
    "UnknownDocumentError": HTTPStatus.NOT_FOUND,
    "CommandError": HTTPStatus.UNPROCESSABLE_ENTITY,
    "InternalError": HTTPStatus.INTERNAL_SERVER_ERROR,
}
"""By kind of the error; every other kind is a conflict with the present state."""
_UNIT_BYTES: Final = 1 << 10
_TO_SAVE: Final = {"content-disposition": 'attachment; filename="robot.urdf"'}
_REFUSALS: Final[dict[int | str, dict[str, Any]]] = {
    status.value: {"model": Refused, "description": "Refused, and why"}
    for status in (*_STATUS.values(), HTTPStatus.CONFLICT)
}


class Health(BaseModel):
    """The studio runs; its version and session."""

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
        """Return all routes, with their models."""
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
        """Return that the studio runs; `session` changes with every start."""
        return Health(version=studio.__version__, session=self._session)

    async def documents(self, request: Request) -> Documents:
        """Return all open documents."""
        listener = Answers(_visitor(request))
        self._engine.attach(listener)
        self._engine.detach(listener)
        found = [event for event in listener.events if isinstance(event, Documents)]
        if not found:  # a relay was told of none yet
            raise CommandError("The studio has not said what is open: ask again in a moment.")
        return found[-1]

    async def urdf(self, document: str, request: Request) -> Response:
        """Return the expanded URDF of the last good run, as a file."""
        command = GetUrdf(document=document).model_dump_json().encode()
        events = await Answers(_visitor(request)).collect(self._engine, command)
        for event in events:
            if isinstance(event, Urdf):
                return _UrdfFile(event.text, headers=_TO_SAVE)
        return _refusal(events) or Response(status_code=HTTPStatus.NOT_FOUND)

    async def command(self, request: Request) -> Response:
        """Carry out one command, as the websocket would."""
        text = await _body(request)
        # By HTTP nobody sends faster than by the websocket.
        await asyncio.sleep(connection_of(request.scope).spend(1 + len(text) / _UNIT_BYTES))
        events = await Answers(_visitor(request)).collect(self._engine, text)
        answer = JSONResponse({"events": [event.model_dump(mode="json") for event in events]})
        return _refusal(events) or answer


class _UrdfFile(Response):
    """A URDF, whatever its text holds."""

    media_type = "application/xml"


def _visitor(request: Request) -> Person:
    return request.scope["state"]["visitor"]


def _refusal(events: list[Event]) -> Response | None:
    """Return the answer for a command that was refused."""
    for event in events:
        if isinstance(event, Refused):
            status = _STATUS.get(event.kind, HTTPStatus.CONFLICT)
            return JSONResponse(event.model_dump(mode="json"), status)
    return None


async def _body(request: Request) -> bytes:
    """Return the whole body, as long as it is no longer than a command may be.

    Raises:
        CommandError: It is longer.
    """
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > COMMAND_LIMIT_BYTES:
            raise CommandError(f"A command of more than {COMMAND_LIMIT_BYTES} bytes is not read.")
    return bytes(body)


class LogsOut(Protocol):
    """The class."""

    async def log_out(self) -> None:
        """Make all members' cookies invalid."""
        ...


class LogOut:
    """The route, and the credentials that it revokes."""

    def __init__(self, credentials: Credentials, classroom: LogsOut) -> None:
        self._credentials, self._classroom = credentials, classroom

    def router(self) -> APIRouter:
        """Return the one route."""
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
        self._credentials.revoke()
        await self._classroom.log_out()
        ending = BackgroundTask(_end_all, request)
        return Response(status_code=HTTPStatus.NO_CONTENT, background=ending)


async def _end_all(request: Request) -> None:
    connection_of(request.scope).end_all()


_REFUSED: Final[dict[int | str, dict[str, Any]]] = {
    HTTPStatus.CONFLICT.value: {"description": "Refused, and why"}
}
_PLAIN: Final = frozenset("-_.() ")
"""What a name in plain quotes may contain besides letters and digits of ASCII."""


_Names = Annotated[Sequence[str], Query(max_length=64)]


class Exports:
    """The routes, and the engine that makes what they send."""

    def __init__(self, engine: OpenDocuments) -> None:
        self._engine = engine

    def router(self) -> APIRouter:
        """Return all routes."""
        router = APIRouter(prefix="/api/documents/{document}/export")
        for endpoint in (self.urdf, self.package, self.page, self.series):
            router.add_api_route(
                f"/{endpoint.__name__}", endpoint, response_class=Response, responses=_REFUSED
            )
        return router

    async def urdf(
        self, document: str, meshes: Literal["package", "absolute", "copied"] = "package"
    ) -> Response:
        """Return the expanded URDF; meshes by package, by path, or copied beside it in a zip."""
        return _sent(await self._engine.document(document).exports.urdf(meshes))

    async def package(
        self, document: str, packages: Literal["entry", "used"] = "entry"
    ) -> Response:
        """Return a zip of the robot's package, or of all it uses, with the unsaved edits."""
        exports = self._engine.document(document).exports
        return _sent(await exports.package(all_used=packages == "used"))

    async def page(self, document: str, theme: Literal["dark", "light"] = "dark") -> Response:
        """Return the 3D view as one page that needs no server."""
        return _sent(await self._engine.document(document).exports.page(dark=theme == "dark"))

    async def series(self, document: str, topic: _Names = (), path: _Names = ()) -> Response:
        """Return plotted numbers over the whole recording as CSV, by topics and as many paths."""
        if len(topic) != len(path):
            raise CommandError("Give each topic its path.")
        lines = list(zip(topic, path, strict=True))
        table = await self._engine.document(document).time.series.table(lines)
        return _sent(Download("plot.csv", "text/csv", table))


class HandedIn:
    """The route for all copies that were handed in, and the engine that has them."""

    def __init__(self, engine: OpenDocuments) -> None:
        self._engine = engine

    def router(self) -> APIRouter:
        """Return the one route."""
        router = APIRouter(prefix="/api")
        router.add_api_route("/copies", self.copies, response_class=Response, responses=_REFUSED)
        return router

    async def copies(self) -> Response:
        """Return a zip with a folder for each person who handed something in."""
        return _sent(self._engine.copies.download())


class WrittenBags:
    """The route for the files of the bags that the studio wrote."""

    def __init__(self, engine: OpenDocuments) -> None:
        self._engine = engine

    def router(self) -> APIRouter:
        """Return the one route."""
        router = APIRouter(prefix="/api")
        router.add_api_route(
            "/bags/{bag}/{file}", self.file, response_class=Response, responses=_REFUSED
        )
        return router

    async def file(self, bag: str, file: str) -> Response:
        """Return a file of a bag, or the part of it that is asked for: it may have many GB."""
        folder = self._engine.bags_folder
        path = folder / bag / file
        if not await asyncio.to_thread(_lies_within, path, folder):
            raise BagNotReadableError(f"{bag}/{file}", "the studio wrote no such file.")
        if self._engine.is_writing(path.parent):
            raise BagNotReadableError(f"{bag}/{file}", "it is being written: wait, or stop it.")
        headers = {"content-security-policy": "sandbox", "cache-control": "no-store"}
        return FileResponse(
            path, filename=file, media_type="application/octet-stream", headers=headers
        )


def _lies_within(path: Path, folder: Path) -> bool:
    """Whether a path leads to a regular file two levels below a folder, links followed."""
    return is_file(path) and path.resolve().parent.parent == folder.resolve()


def _sent(download: Download) -> Response:
    headers = {
        "content-disposition": disposition(download.name),
        "cache-control": "no-store",
        # Opened in the browser instead of being saved, it has no power over the studio.
        "content-security-policy": "sandbox",
    }
    return StreamingResponse(download.chunks, media_type=download.media_type, headers=headers)


def disposition(name: str) -> str:
    """Content-Disposition (RFC 6266) under which a browser saves a file by its name."""
    name = "".join(one for one in name if one.isprintable() and one not in "/\\") or "download"
    plain = "".join(
        one if (one.isascii() and one.isalnum()) or one in _PLAIN else "_" for one in name
    )
    return f"attachment; filename=\"{plain}\"; filename*=UTF-8''{quote(name, safe='')}"
