"""Files dropped on the page: one request holds them all, so that half a robot never arrives."""

from collections.abc import AsyncIterator
from http import HTTPStatus
from typing import Annotated, Any, Final

from fastapi import APIRouter, Query, Request
from pydantic import BaseModel
from starlette.requests import ClientDisconnect
from starlette.responses import JSONResponse, Response

from studio.errors import StudioError, UploadError
from studio.packages.uploads import MANIFEST_LIMIT_BYTES
from studio.server.surface import OpenDocuments
from studio.settings import ZIP_SIZE_LIMIT_BYTES

_BODY: Final[dict[str, Any]] = {
    "requestBody": {
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
        "description": (
            'One line of JSON, `[{"path": "robot.urdf", "size": 812}, ...]`, a line feed, and then '
            "the bytes of these files, one after the other."
        ),
    }
}


Beside = Annotated[
    str, Query(max_length=200, description="The open document that shall show a sent bag.")
]


class Uploaded(BaseModel):
    """The files are open: go to `/d/<document>`."""

    document: str


class Uploads:
    """The route, and the engine that keeps and opens what comes."""

    def __init__(self, engine: OpenDocuments) -> None:
        self._engine = engine

    def router(self) -> APIRouter:
        """Return the one route."""
        router = APIRouter(prefix="/api")
        router.add_api_route(
            "/uploads",
            self.take,
            methods=["POST"],
            response_model=Uploaded,
            responses={HTTPStatus.CONFLICT.value: {"description": "Refused, and why"}},
            openapi_extra=_BODY,
        )
        return router

    async def take(self, request: Request, beside: Beside = "") -> Response:
        """Keep the sent files in the data folder, and open the robot or the bag among them."""
        stream = request.stream()
        try:
            line, rest = await _first_line(stream)
            document = await self._engine.uploads.take(line, _and_then(rest, stream), beside)
        except ClientDisconnect:  # it was cancelled, and nobody reads the answer
            return Response(status_code=HTTPStatus.BAD_REQUEST)
        except StudioError as error:
            await _drain(stream)
            refusal = {"kind": type(error).__name__, "reason": str(error)}
            return JSONResponse(refusal, HTTPStatus.CONFLICT)
        return JSONResponse(Uploaded(document=document).model_dump())


async def _first_line(stream: AsyncIterator[bytes]) -> tuple[bytes, bytes]:
    """Return the announcement, and what came with it of the files.

    Raises:
        UploadError: It does not end.
    """
    begun = bytearray()
    async for chunk in stream:
        begun += chunk
        line, end, rest = bytes(begun).partition(b"\n")
        if end:
            return line, rest
        if len(begun) > MANIFEST_LIMIT_BYTES:
            break
    raise UploadError("the list of files is missing or too long.")


async def _and_then(first: bytes, stream: AsyncIterator[bytes]) -> AsyncIterator[bytes]:
    yield first
    async for chunk in stream:
        yield chunk


async def _drain(stream: AsyncIterator[bytes]) -> None:
    """Read the rest: a browser whose sending is cut off does not show the answer."""
    drained = 0
    try:
        async for chunk in stream:
            drained += len(chunk)
            if drained > ZIP_SIZE_LIMIT_BYTES:
                return
    except (ClientDisconnect, RuntimeError):  # it went, or all was read before
        return
