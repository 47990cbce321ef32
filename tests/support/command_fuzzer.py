"""Commands made at random from the schema that parses them, most of them well-formed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, cast

from studio.server.schema import Schema, wire_schemas

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from random import Random

WORDS: Final = (
    *("", " ", "a", "base", "wheel_radius", "robot", "/", "..", "a..b", "x" * 64, "\0", "a\0b"),
    *(
        "/chatter",
        "~x",
        "std_msgs/msg/String",
        "data: 1",
        "{",
        "[[[[",
        "${1/0}",
        "${x",
        "$(find y)",
    ),
    *(
        "<link",
        "<!--",
        "&lt;",
        "]]>",
        "é\u0301🤖\u202e",
        "\ufeff",
        "\r\n",
        "\t",
        "-0",
        "1e999",
        "nan",
    ),
    *("0.1", "true", "%s%n", "../../etc/passwd", "file:///etc/passwd", "package://a/b", "x" * 5000),
)
ADDRESSES: Final = ("", "a..b", "x" * 64, "tcp/", "127.0.0.1:1", "tcp/127.0.0.1:1", "udp/\0:1", "é")
"""None that leads out of this machine."""
_NUMBERS: Final = (0, 1, -1, 2, 7, 100, 4096, 1 << 31, 1 << 53, -(1 << 63))
_REFERENCE: Final = "#/components/schemas/"
_LONGEST: Final = 6
"""Items of a list, where more may be."""


class CommandFuzzer:
    """Makes commands; `known` are texts by field name, from which most of that field are taken."""

    def __init__(self, random: Random, known: Mapping[str, Sequence[str]]) -> None:
        self._random, self.known = random, known
        self._schemas = wire_schemas()
        self.kinds = tuple(one["$ref"] for one in self._schemas["Command"]["oneOf"])

    def command(self, request: int) -> dict[str, Any]:
        """One command with that number."""
        made = self._value({"$ref": self._random.choice(self.kinds)}, "")
        return {**made, "request": request}

    def _value(self, schema: Schema, name: str) -> Any:  # noqa: ANN401, PLR0911 - any JSON
        if reference := schema.get("$ref"):
            return self._value(self._schemas[reference.removeprefix(_REFERENCE)], name)
        if "const" in schema:
            return schema["const"]
        for choice in ("enum", "anyOf", "oneOf"):
            if choice in schema:
                chosen: Any = self._random.choice(schema[choice])
                return chosen if choice == "enum" else self._value(chosen, name)
        match schema.get("type"):
            case "object":
                return self._object(schema)
            case "array":
                return self._array(schema, name)
            case "string":
                return self._text(schema, name)
            case "boolean":
                return self._random.random() < 0.5
            case "integer" | "number":
                return self._number(schema)
            case _:
                return None

    def _object(self, schema: Schema) -> dict[str, Any]:
        fields: dict[str, Any] = {}
        for name, one in cast("dict[str, Schema]", schema.get("properties", {})).items():
            if name == "type" or name in schema.get("required", ()) or self._random.random() < 0.8:
                fields[name] = self._value(one, name)
        more: Any = schema.get("additionalProperties")
        if isinstance(more, dict):
            for _ in range(self._random.randrange(3)):
                key = self._text(schema.get("propertyNames", {}), "name")
                fields[key] = self._value(cast("Schema", more), "value")
        return fields

    def _array(self, schema: Schema, name: str) -> list[Any]:
        if "prefixItems" in schema:
            return [self._value(one, name) for one in schema["prefixItems"]]
        least = schema.get("minItems", 0)
        most = min(schema.get("maxItems", _LONGEST), max(_LONGEST, least))
        return [
            self._value(schema["items"], name) for _ in range(self._random.randint(least, most))
        ]

    def _text(self, schema: Schema, name: str) -> str:
        known = self.known.get(name)
        if known and self._random.random() < 0.85:
            return self._random.choice(known)
        words = ADDRESSES if name == "address" else WORDS
        text = "".join(self._random.choices(words, k=self._random.choice((1, 1, 1, 2))))
        return text[: schema.get("maxLength", len(text))]

    def _number(self, schema: Schema) -> float:
        least, most = schema.get("minimum"), schema.get("maximum")
        if self._random.random() < 0.5:
            number = float(self._random.randrange(200))
        else:
            number = float(self._random.choice(_NUMBERS))
        if schema["type"] == "number":
            number *= self._random.choice((1.0, 0.1, 1e-300))
        number = number if least is None else max(number, least)
        number = number if most is None else min(number, most)
        return int(number) if schema["type"] == "integer" else number
