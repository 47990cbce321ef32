"""Writes `frontend_assets/types/wire.d.ts`: `python -m studio.server.wire_types`."""

from __future__ import annotations

import json
import textwrap
from typing import TYPE_CHECKING, Final

from studio.server.schema import wire_schemas
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from pathlib import Path

    from studio.server.schema import Schema

_HEADER: Final = """\
// Written by `python -m studio.server.wire_types` from studio/protocol/: do not edit.
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
    """The whole file."""
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
    """One model, or one enumeration; an event is sent with its defaults, a command without."""
    comment = _comment(schema.get("description", ""), indent="")
    if "properties" not in schema:
        return f"{comment}export type {name} = {_type(schema)};\n"
    required = set(schema["properties"] if is_sent_whole else schema.get("required", ()))
    lines = [f"{comment}export interface {name} {{"]
    for field, described in schema["properties"].items():
        # The discriminator has a default in Python, but only what is sent tells the kinds apart.
        optional = "" if field in required or "const" in described else "?"
        lines.append(_comment(described.get("description", ""), indent="  ").rstrip("\n"))
        lines.append(f"  {field}{optional}: {_type(described)};")
    return "\n".join([*filter(None, lines), "}", ""])


def _union(name: str, schema: Schema) -> str:
    kinds = "\n".join(f"  | {_type(one)}" for one in schema["oneOf"])
    return f"export type {name} =\n{kinds};\n"


def _type(schema: Schema) -> str:
    """The TypeScript type of one schema."""
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
    """A tuple of fixed length, or any number of one type."""
    if "prefixItems" in schema:
        return f"[{', '.join(_type(one) for one in schema['prefixItems'])}]"
    item = _type(schema["items"])
    return f"({item})[]" if " | " in item else f"{item}[]"


def _comment(text: str, indent: str) -> str:
    """The model's own words before what they describe."""
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
    """Where the file is kept."""
    return repository_or_wheel("frontend_assets") / "types" / "wire.d.ts"


def main() -> None:
    """Write the file."""
    path = target()
    path.parent.mkdir(exist_ok=True)
    path.write_text(wire_types(), encoding="utf-8")


if __name__ == "__main__":
    main()
