"""Downloads: the robot as URDF, as a zip of its packages, and as a page of its own."""

from http import HTTPStatus
from typing import Any, Final, Literal
from urllib.parse import quote

from fastapi import APIRouter
from starlette.responses import Response, StreamingResponse

from studio.documents.keeping.exports import Download
from studio.server.surface import OpenDocuments

_REFUSED: Final[dict[int | str, dict[str, Any]]] = {
    HTTPStatus.CONFLICT.value: {"description": "Refused, and why"}
}
_PLAIN: Final = frozenset("-_.() ")
"""What a name in plain quotes may hold beside letters and digits of ASCII."""


class Exports:
    """The routes, and the engine that makes what they send."""

    def __init__(self, engine: OpenDocuments) -> None:
        self._engine = engine

    def router(self) -> APIRouter:
        """All routes."""
        router = APIRouter(prefix="/api/documents/{document}/export")
        for path, endpoint in (("urdf", self.urdf), ("package", self.package), ("page", self.page)):
            router.add_api_route(f"/{path}", endpoint, response_class=Response, responses=_REFUSED)
        return router

    async def urdf(
        self, document: str, meshes: Literal["package", "absolute", "copied"] = "package"
    ) -> Response:
        """The expanded URDF; its meshes by package, by path, or copied beside it in a zip."""
        return _sent(await self._engine.document(document).exports.urdf(meshes))

    async def package(
        self, document: str, packages: Literal["entry", "used"] = "entry"
    ) -> Response:
        """A zip of the robot's package, or of all it uses, with the unsaved edits."""
        exports = self._engine.document(document).exports
        return _sent(await exports.package(all_used=packages == "used"))

    async def page(self, document: str, theme: Literal["dark", "light"] = "dark") -> Response:
        """The 3D view as one page that needs no server."""
        return _sent(await self._engine.document(document).exports.page(dark=theme == "dark"))


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
