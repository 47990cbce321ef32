"""The `params` of a macro: read as xacro reads it, with the place of each parameter in the file.

Source: xacro 2.1.1's grammar: `name`, `*block`, `**blocks`, `name:=default`, `name=default`,
`name:=^` (the caller's value) and `name:=^|default`. A default is one `${...}`, one `$(...)`, or
text without blanks, in which quoted parts may have blanks.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final

from studio.description.faults import Refusal
from studio.description.syntax.attribute_spans import (
    attribute_bytes,
    attribute_text,
    character_offsets,
)
from studio.description.values import Span
from studio.errors import EditError

DEFAULT: Final = r"""\$\{.*?\}|\$\(.*?\)|(?:(?>'.*?')|(?>".*?")|[^\s'"]++)+|"""
"""As xacro's, but without backtracking, which could take forever."""
_PARAMETER: Final = re.compile(r"^\s*([^\s:=]+?)\s*:?=\s*(\^\|?)?(" + DEFAULT + r")(?:\s+|$)(.*)")
_AS_XACRO: Final = re.compile(re.sub(r"\(\?>([^)]*)\)", r"\1", _PARAMETER.pattern))
"""Xacro's own, where few quotes leave few ways to pair them; with many all must have their pair."""
_QUOTES_LIMIT: Final = 12
PARAMS_LIMIT: Final = 20_000
"""Characters of `params`."""
_PARAM = re.compile(rf"\s*([^\s:=]+?)\s*:?=\s*(?:\^\|?)?({DEFAULT})(?:\s+|$)")
_NO_DEFAULT = re.compile(r"\s*\S+(?:\s+|$)")
_UNAMBIGUOUS = re.compile(r"""\$\{.*\}|\$\(.*\)|(?!\$[{(])(?:'[^']*'|"[^"]*"|[^\s'"]++)+""")
"""Defaults that end where they should, whatever follows: the grammar's `.*?` reaches further."""
_QUOTED = re.compile(r"""'[^']*'|"[^"]*\"""")


@dataclass(frozen=True, slots=True)
class Default:
    """The value of a parameter that a call does not give.

    `forward`: the value of the same name where the macro is called (`:=^`); `text`: evaluated
    there, after `^|` only if that name is not defined.
    """

    forward: bool
    text: str | None


def read_parameters(text: str) -> tuple[list[str], dict[str, Default]]:
    """Read `params="a b:=1 c:='x y' d:=^|3 *block **blocks"`.

    Raises:
        Refusal: It is longer than PARAMS_LIMIT.
    """
    if len(text) > PARAMS_LIMIT:
        raise Refusal("params-too-long", "The params of a macro are too long to be read.")
    names: list[str] = []
    defaults: dict[str, Default] = {}
    while text.strip():
        name, default, text = parameter(text)
        names.append(name)
        if default is not None:
            defaults[name] = default
    return names, defaults


def parameter(text: str) -> tuple[str, Default | None, str]:
    """Return the first parameter of a `params`, its default, and the text behind it."""
    quotes = sum(map(text.count, "'\""))
    match = (_AS_XACRO if quotes <= _QUOTES_LIMIT else _PARAMETER).match(text)
    if match is None:
        name, *rest = text.lstrip().split(None, 1)
        return name, None, rest[0] if rest else ""
    name, forward, default, rest = match.groups()
    return name, Default(forward is not None, default or None), rest


@dataclass(frozen=True, slots=True)
class ParamDefault:
    """One default: the parameter's name, the place of its text, and the text without quotes."""

    name: str
    span: Span
    text: str


def param_defaults(data: bytes, params: Span, encoding: str = "utf-8") -> tuple[ParamDefault, ...]:
    """Return the written defaults of a macro, given the span of its `params` attribute.

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
    """Return the text of one default from its raw bytes: references resolved, outer quotes off."""
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


def name_in_params(text: str, name: str) -> int:
    """Return where `params` names a parameter, without its stars; -1 when it does not."""
    if len(text) > PARAMS_LIMIT:
        return -1
    at = 0
    while (rest := text[at:]).strip():
        found, _, behind = parameter(rest)
        if found.lstrip("*") == name:
            return at + len(rest) - len(rest.lstrip()) + len(found) - len(name)
        at = len(text) - len(behind)
    return -1
