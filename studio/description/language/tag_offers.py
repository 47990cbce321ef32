"""Elements and attributes that may stand at a cursor: those of xacro, calls of macros, URDF."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.description.language.definitions import parameters_of
from studio.description.language.documentation import documentation_of, parameter_documentation
from studio.description.language.offers import Offer, Snippet, plain, written
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.words import (
    ATTRIBUTES,
    ELEMENTS,
    WITH_CONTENT,
    WRITTEN_WITH,
    XACRO_TAGS,
    XACRO_WITH_CONTENT,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.language.cursor import Cursor
    from studio.description.language.questions import Parameter
    from studio.description.language.token_at import Tag

_LIKELY, _FITTING, _MACRO, _POSSIBLE = range(4)
_NUMBER: Final = re.compile(r"[+-]?(?:\d|\.\d)")


def tag_offers(cursor: Cursor, *, opening: str = "") -> Iterator[Offer]:
    """Elements that may begin here; `opening` is written before them: `<`, or nothing."""
    tag = cursor.token.tag
    is_begun = tag is not None and (bool(tag.attributes) or cursor.text[tag.end - 1 :][:1] == ">")
    yield from _xacro_tags(opening, is_begun=is_begun)
    yield from _macro_calls(cursor, opening, is_begun=is_begun)
    yield from _elements(cursor, opening, is_begun=is_begun)


def _xacro_tags(opening: str, *, is_begun: bool) -> Iterator[Offer]:
    for name, (needed, _) in XACRO_TAGS.items():
        label = f"xacro:{name}"
        group = _LIKELY if name in {"property", "include", "macro", "arg", "if"} else _FITTING
        if is_begun:
            yield plain(group, Kind.TAG, label, insert=opening + label)
            continue
        snippet = Snippet().write(opening + label)
        for attribute in needed:
            snippet.attribute(attribute)
        _close(snippet, label, has_content=name in XACRO_WITH_CONTENT)
        yield written(group, Kind.TAG, label, snippet)


def _close(snippet: Snippet, label: str, *, has_content: bool) -> None:
    if has_content:
        snippet.write(">").stop().write(f"</{label}>")
    else:
        snippet.write("/>")


def _macro_calls(cursor: Cursor, opening: str, *, is_begun: bool) -> Iterator[Offer]:
    """A call of each macro, with the parameters that it needs."""
    for name, params, doc in _macros(cursor):
        label = f"xacro:{name}"
        parameters = parameters_of(params)
        detail = " ".join(_signature(one) for one in parameters)
        if is_begun:
            yield plain(_MACRO, Kind.MACRO, label, insert=opening + label, detail=detail, doc=doc)
            continue
        snippet = call_snippet(name, parameters, opening)
        yield written(_MACRO, Kind.MACRO, label, snippet, detail=detail, doc=doc)


def call_snippet(name: str, parameters: tuple[Parameter, ...], opening: str = "<") -> Snippet:
    """A call with the values that it must give, and a place for its blocks."""
    label = f"xacro:{name}"
    snippet = Snippet().write(opening + label)
    for one in parameters:
        if one.kind == "value" and one.is_required:
            snippet.attribute(one.name)
    _close(snippet, label, has_content=any(one.kind != "value" for one in parameters))
    return snippet


def _macros(cursor: Cursor) -> Iterator[tuple[str, str, str]]:
    """(name, params, documentation) of the run's macros, and of those only this text knows."""
    definitions = cursor.reading.definitions
    known: set[str] = set()
    for name, element in definitions.macros if definitions else ():
        known.add(name)
        yield name, element.attributes.get("params", ""), documentation_of(element)
    for tag in cursor.declarations:
        name = cursor.written(tag, "name")
        if tag.name == "xacro:macro" and name and name not in known:
            yield name, cursor.written(tag, "params"), ""


def _signature(one: Parameter) -> str:
    stars = {"value": "", "block": "*", "blocks": "**"}[one.kind]
    return f"{stars}{one.name}" if one.is_required else f"{stars}{one.name}?"


def _elements(cursor: Cursor, opening: str, *, is_begun: bool) -> Iterator[Offer]:
    """Elements of URDF, those that fit the element around first."""
    around = next((one.name for one in reversed(cursor.around) if one.name in ELEMENTS), "")
    is_direct = bool(cursor.around) and cursor.around[-1].name == around
    fitting = ELEMENTS.get(around, ())
    names = dict.fromkeys((*fitting, *(name for some in ELEMENTS.values() for name in some)))
    for name in names:
        if name not in fitting and is_direct:
            continue
        group = _LIKELY if name in fitting else _POSSIBLE
        if is_begun:
            yield plain(group, Kind.ELEMENT, name, insert=opening + name)
            continue
        snippet = Snippet().write(opening + name)
        for attribute in WRITTEN_WITH.get(name, ()):
            snippet.attribute(attribute)
        _close(snippet, name, has_content=name in WITH_CONTENT)
        yield written(group, Kind.ELEMENT, name, snippet)


def closing_offers(cursor: Cursor) -> Iterator[Offer]:
    """The closing tags of what is open, the innermost first."""
    rest = "" if cursor.text[cursor.token.end :][:1] == ">" else ">"
    start = cursor.text.rfind("<", 0, cursor.index)
    names = [one.name for one in reversed(cursor.open_before(start))]
    for group, name in enumerate(dict.fromkeys(names)):
        yield plain(group, Kind.ELEMENT, name, insert=name + rest)


def attribute_offers(cursor: Cursor, tag: Tag) -> Iterator[Offer]:
    """Attributes that the tag may have and has not; those that it needs first."""
    given = {one.name for one in tag.attributes if one is not cursor.token.attribute}
    own = tag.name.removeprefix("xacro:")
    if own == tag.name:
        names = ATTRIBUTES.get(tag.name, ())
        yield from _attributes(cursor, names, Kind.ATTRIBUTE, _LIKELY, given)
    elif own in XACRO_TAGS:
        needed, possible = XACRO_TAGS[own]
        yield from _attributes(cursor, needed, Kind.ATTRIBUTE, _LIKELY, given)
        yield from _attributes(cursor, possible, Kind.ATTRIBUTE, _FITTING, given)
    else:
        yield from _parameters(cursor, own, given)


def _attributes(
    cursor: Cursor, names: tuple[str, ...], kind: Kind, group: int, given: set[str]
) -> Iterator[Offer]:
    for name in names:
        if name not in given:
            yield _attribute(cursor, group, kind, name)


def _attribute(
    cursor: Cursor, group: int, kind: Kind, name: str, detail: str = "", doc: str = ""
) -> Offer:
    if cursor.text[cursor.token.end :].lstrip()[:1] == "=":
        return plain(group, kind, name, detail=detail, doc=doc)
    snippet = Snippet().write(f'{name}="').stop().write('"')
    return written(group, kind, name, snippet, detail=detail, doc=doc)


def _parameters(cursor: Cursor, macro: str, given: set[str]) -> Iterator[Offer]:
    """The parameters of the macro that a tag calls."""
    for name, params, doc in _macros(cursor):
        if name != macro:
            continue
        for one in parameters_of(params):
            if one.kind == "value" and one.name not in given:
                group = _LIKELY if one.is_required else _FITTING
                said = parameter_documentation(doc, one.name)
                detail = "" if one.default is None else one.default
                yield _attribute(cursor, group, Kind.PARAMETER, one.name, detail, said)
