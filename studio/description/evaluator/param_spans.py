"""Where the defaults of a macro's parameters stand inside its `params` attribute.

Source: xacro 2.1.1's grammar: `name`, `*block`, `**blocks`, `name:=default`, `name=default`,
`name:=^` (the caller's value) and `name:=^|default`. A default is one `${...}`, one `$(...)`, or
words without blanks, in which quoted parts may hold blanks.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from studio.description.evaluator.macros import DEFAULT, PARAMS_LIMIT
from studio.description.syntax.attribute_spans import (
    attribute_bytes,
    attribute_text,
    character_offsets,
)
from studio.description.values import Span
from studio.errors import EditError

_PARAM = re.compile(rf"\s*([^\s:=]+?)\s*:?=\s*(?:\^\|?)?({DEFAULT})(?:\s+|$)")
_NO_DEFAULT = re.compile(r"\s*\S+(?:\s+|$)")
_UNAMBIGUOUS = re.compile(r"""\$\{.*\}|\$\(.*\)|(?!\$[{(])(?:'[^']*'|"[^"]*"|[^\s'"]++)+""")
"""Defaults that end where they should, whatever follows: the grammar's `.*?` reaches further."""
_QUOTED = re.compile(r"""'[^']*'|"[^"]*\"""")


@dataclass(frozen=True, slots=True)
class ParamDefault:
    """One default: the parameter's name, where its text stands, and the text without quotes."""

    name: str
    span: Span
    text: str


def param_defaults(data: bytes, params: Span, encoding: str = "utf-8") -> tuple[ParamDefault, ...]:
    """The written defaults of a macro, given the span of its `params` attribute.

    Raises:
        EditError: The bytes are not of that encoding.
    """
    text, offsets = character_offsets(data[params.start : params.end], encoding)
    syntax = "param" if params.syntax == '"' else "param'"
    defaults: list[ParamDefault] = []
    position = 0
    while position < len(text) <= PARAMS_LIMIT:
        found = _PARAM.match(text, position)
        if found is not None and found[2]:
            start, end = (
                params.start + offsets[found.start(2)],
                params.start + offsets[found.end(2)],
            )
            defaults.append(ParamDefault(found[1], Span(start, end, syntax), _unquoted(found[2])))
        found = found or _NO_DEFAULT.match(text, position)
        if found is None:
            break
        position = found.end()
    return tuple(defaults)


def _unquoted(default: str) -> str:
    return default[1:-1] if _QUOTED.fullmatch(default) else default


def param_text(raw: bytes, encoding: str = "utf-8") -> str:
    """The text of one default from its raw bytes: references resolved, outer quotes off."""
    return _unquoted(attribute_text(raw, encoding))


def param_bytes(text: str, like: str, xml_quote: str, encoding: str = "utf-8") -> bytes:
    """Spell `text` as a default, in the quotes of the default `like`, else only quoted if needed.

    Raises:
        EditError: The grammar cannot hold the text: it needs quotes and holds both kinds.
    """
    wanted = like[0] if _QUOTED.fullmatch(like) else ""
    for quote in (wanted, "'", '"'):
        default = f"{quote}{text}{quote}"
        if _is_one_default(default, text if quote else None):
            return attribute_bytes(default, xml_quote, encoding)
    raise EditError(
        f"A parameter's default cannot be written as {text!r}: use one kind of quotes only."
    )


def _is_one_default(default: str, quoted_text: str | None) -> bool:
    """Whether the grammar reads `default` back as a whole, with this text when it is quoted."""
    if any(blank in default for blank in "\t\n\r"):
        return False
    found = _PARAM.fullmatch(f"p:={default}")
    if found is None or found[2] != default or not _UNAMBIGUOUS.fullmatch(default):
        return False
    followed = _PARAM.match(f"p:={default} q:=1")
    if followed is None or followed[2] != default:
        return False
    if quoted_text is None:
        return _QUOTED.fullmatch(default) is None
    return _QUOTED.fullmatch(default) is not None and _unquoted(default) == quoted_text
