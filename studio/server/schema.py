"""The JSON schemas of the wire, from the same models that parse it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from fastapi.openapi.utils import get_openapi
from pydantic import TypeAdapter

import studio
from studio.protocol.message import adapter_of, all_events
from studio.server.commands import COMMAND_ADAPTER

if TYPE_CHECKING:
    from starlette.routing import BaseRoute

Schema = dict[str, Any]

EVENT_ADAPTER: Final = adapter_of(all_events())
"""Parses every event."""
_REFERENCE: Final = "#/components/schemas/{model}"
COMMAND_BODY: Final[Schema] = {
    "requestBody": {
        "required": True,
        "content": {"application/json": {"schema": {"$ref": "#/components/schemas/Command"}}},
    }
}
"""For the one route that takes a command; its text is parsed as the websocket's is."""


def wire_schemas() -> dict[str, Schema]:
    """Schema by name: every command, every event, what they hold, `Command` and `Event`."""
    kinds, whole = TypeAdapter.json_schemas(
        [("Command", "validation", COMMAND_ADAPTER), ("Event", "serialization", EVENT_ADAPTER)],
        ref_template=_REFERENCE,
    )
    schemas: dict[str, Schema] = dict(whole["$defs"])
    schemas["Command"] = kinds["Command", "validation"]
    schemas["Event"] = kinds["Event", "serialization"]
    return schemas


def openapi(routes: list[BaseRoute]) -> Schema:
    """The OpenAPI document of these routes, with the whole wire in it."""
    document = get_openapi(
        title="Robot description studio",
        version=studio.__version__,
        description=(
            "The commands and events of the websocket `/control` (send a `Command`, receive each "
            "`Event` as JSON text) and the same commands by request. Authorise with "
            "`Authorization: Bearer <token of the printed address>`."
        ),
        routes=routes,
    )
    document.setdefault("components", {}).setdefault("schemas", {}).update(wire_schemas())
    return document
