"""The JSON schemas of the wire, from the models that parse it, and the page's types of them.

`python -m studio.server.schema` writes `frontend_assets/types/wire.d.ts`.
"""

from __future__ import annotations

import json
import textwrap
from typing import TYPE_CHECKING, Any, Final

from fastapi.openapi.utils import get_openapi
from pydantic import TypeAdapter

import studio
from studio.server.commands import COMMAND_ADAPTER, EVENT_ADAPTER
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from starlette.routing import BaseRoute


Schema = dict[str, Any]

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
    """Return the OpenAPI document of these routes, with the whole wire in it."""
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


_HEADER: Final = """\
// Written by `python -m studio.server.schema` from studio/protocol/: do not edit.
// A command goes to the websocket /control as JSON text; each event comes from it as JSON text.
"""
_NAMES: Final = {
    "string": "string",
    "integer": "number",
    "number": "number",
    "boolean": "boolean",
    "null": "null",
}
_WIDTH: Final = 96


def wire_types() -> str:
    """Return the whole file."""
    schemas = wire_schemas()
    unions = ("Command", "Event")
    parts = [_HEADER]
    commands = {_type(one) for one in schemas["Command"]["oneOf"]}
    parts += [
        _interface(name, schemas[name], is_sent_whole=name not in commands)
        for name in sorted(schemas.keys() - set(unions))
    ]
    parts += [_union(name, schemas[name]) for name in unions]
    return "\n".join(parts)


def _interface(name: str, schema: Schema, *, is_sent_whole: bool) -> str:
    """Return one model or enumeration; an event is sent with its defaults, a command without."""
    comment = _comment(schema.get("description", ""), indent="")
    if "properties" not in schema:
        return f"{comment}export type {name} = {_type(schema)};\n"
    required = set(schema["properties"] if is_sent_whole else schema.get("required", ()))
    lines = [f"{comment}export interface {name} {{"]
    for field, described in schema["properties"].items():
        # The discriminator has a default in Python, but it must be sent to tell the kinds apart.
        optional = "" if field in required or "const" in described else "?"
        lines.append(_comment(described.get("description", ""), indent="  ").rstrip("\n"))
        lines.append(f"  {field}{optional}: {_type(described)};")
    return "\n".join([*filter(None, lines), "}", ""])


def _union(name: str, schema: Schema) -> str:
    kinds = "\n".join(f"  | {_type(one)}" for one in schema["oneOf"])
    return f"export type {name} =\n{kinds};\n"


def _type(schema: Schema) -> str:
    """Return the TypeScript type of one schema."""
    if "$ref" in schema:
        return str(schema["$ref"]).rsplit("/", 1)[-1]
    if "const" in schema or "enum" in schema:
        return " | ".join(json.dumps(value) for value in schema.get("enum", [schema.get("const")]))
    if options := schema.get("anyOf") or schema.get("oneOf"):
        return " | ".join(dict.fromkeys(_type(one) for one in options))
    if schema["type"] == "object":
        return f"Record<string, {_type(schema['additionalProperties'])}>"
    return _array(schema) if schema["type"] == "array" else _NAMES[schema["type"]]


def _array(schema: Schema) -> str:
    """Return a tuple of fixed length, or any number of one type."""
    if "prefixItems" in schema:
        return f"[{', '.join(_type(one) for one in schema['prefixItems'])}]"
    item = _type(schema["items"])
    return f"({item})[]" if " | " in item else f"{item}[]"


def _comment(text: str, indent: str) -> str:
    """Return the model's docstring as a comment."""
    if not text:
        return ""
    lines = list(_wrapped(text.split("\n\n")))
    if len(lines) == 1:
        return f"{indent}/** {lines[0]} */\n"
    body = "".join(f"{indent} * {line}".rstrip() + "\n" for line in lines)
    return f"{indent}/**\n{body}{indent} */\n"


def _wrapped(paragraphs: Iterable[str]) -> Iterator[str]:
    for number, paragraph in enumerate(paragraphs):
        if number:
            yield ""
        yield from textwrap.wrap(paragraph.replace("*/", "* /"), _WIDTH)


def target() -> Path:
    """Return the path of the file."""
    return repository_or_wheel("frontend_assets") / "types" / "wire.d.ts"


def main() -> None:
    """Write the file."""
    path = target()
    path.parent.mkdir(exist_ok=True)
    path.write_text(wire_types(), encoding="utf-8")


if __name__ == "__main__":
    main()
