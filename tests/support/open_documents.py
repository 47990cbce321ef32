"""An Engine on this process's loop with real workers, and a page's ear at it."""

from __future__ import annotations

import asyncio
import json
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

from studio.documents.engine import Engine
from studio.protocol.roles import Role, Visitor
from studio.settings import Settings

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable
    from pathlib import Path

    from studio.documents.document import Document

_PATIENCE_S = 60.0


class Ear:
    """A control lane that keeps what it hears."""

    def __init__(self, role: Role = Role.PRESENTER) -> None:
        self.role, self.person = role, ""
        self.events: list[dict[str, Any]] = []
        self.frames: list[bytes] = []

    def sees(self, document: str) -> bool:
        """What its role may look at."""
        return Visitor(self.role).sees(document)

    def post(self, data: bytes, *, binary: bool = False, key: str | None = None) -> None:
        del key  # everything is kept
        if binary:
            self.frames.append(data)
        else:
            self.events.append(json.loads(data))

    def last(self, kind: str) -> dict[str, Any]:
        """The newest event of a kind."""
        return next(event for event in reversed(self.events) if event["type"] == kind)

    def sites(self) -> dict[str, dict[str, Any]]:
        """Every site as it was told last, by id."""
        told = (event for event in self.events if event["type"] == "sites")
        return {site["id"]: site for event in told for site in event["changed"]}

    def site(self, name: str) -> dict[str, Any]:
        """The site whose name ends so."""
        return next(site for site in self.sites().values() if site["name"].endswith(name))


@asynccontextmanager
async def engine(data_folder: Path, *package_paths: Path) -> AsyncGenerator[Engine]:
    """An engine that is closed with the block; no worker process is started before it is needed."""
    data_folder.mkdir(parents=True, exist_ok=True)
    made = Engine(Settings(data_folder=data_folder, package_paths=package_paths))
    try:
        yield made
    finally:
        await made.close()


async def opened(made: Engine, path: Path, **arguments: str) -> tuple[Document, Ear]:
    """Open a path, wait for the robot and its meshes; the document and an ear at it."""
    document = made.document(await made.open_path(path, arguments))
    ear = Ear()
    document.attach(ear)
    await document.opened()
    return document, ear


async def until(holds: Callable[[], bool]) -> None:
    """Let the loop run until that holds."""
    async with asyncio.timeout(_PATIENCE_S):
        while not holds():  # noqa: ASYNC110 - nothing tells us when
            await asyncio.sleep(0.01)
