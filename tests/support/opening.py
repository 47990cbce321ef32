"""What the page asks of an engine to open something, and what came of it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.support.open_documents import Ear

if TYPE_CHECKING:
    from studio.documents.document import Document
    from studio.documents.engine import Engine
    from studio.protocol import Command

ROBOT = b'<robot name="r"><link name="base"/></robot>'


async def asked(made: Engine, command: Command) -> dict[str, Any]:
    """The answer of a command, before its `done`."""
    ear = Ear()
    await made.execute(command, ear)
    assert ear.events[-1]["type"] == "done"
    return next(event for event in reversed(ear.events[:-1]) if "request" in event)


async def document_of(made: Engine, command: Command) -> Document:
    """The document that a command opened, once its robot and meshes are there."""
    document = made.document((await asked(made, command))["document"])
    await document.opened()
    return document


def sentences(document: Document) -> list[str]:
    ear = Ear()
    document.attach(ear)
    return [one["sentence"] for one in ear.last("problems")["problems"]]
