"""Completions at a cursor, by its place in the markup."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING, Final

from studio.description.language.definitions import (
    documentation_of,
    parameter_documentation,
    parameters_of,
)
from studio.description.language.name_offers import (
    expression_offers,
    name_around,
    substitution_offers,
)
from studio.description.language.named_files import names_in, path_named
from studio.description.language.offers import Offer, Snippet, chosen, plain, written
from studio.description.language.questions import Completions
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.token_at import Where
from studio.description.language.words import (
    ATTRIBUTES,
    ELEMENTS,
    FILE_ATTRIBUTES,
    PART_REFERENCES,
    VALUES,
    WITH_CONTENT,
    WRITTEN_WITH,
    XACRO_TAGS,
    XACRO_VALUES,
    XACRO_WITH_CONTENT,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.language.cursor import Cursor
    from studio.description.language.questions import Parameter
    from studio.description.language.token_at import Attribute, Segment, Tag

_LIKELY, _FITTING, _MACRO, _POSSIBLE = range(4)
_BOOLEANS: Final = ("true", "false")
_SCHEME: Final = "package://"


def completions_at(cursor: Cursor) -> Completions:
    """Return the completions at a cursor; none inside of comments and the like."""
    token = cursor.token
    match token.where:
        case Where.SILENT:
            return _nothing(cursor)
        case Where.TAG_NAME:
            return chosen(tag_offers(cursor), cursor, token.start, token.end)
        case Where.CLOSING:
            return chosen(closing_offers(cursor), cursor, token.start, token.end)
        case Where.ATTRIBUTE_NAME if token.tag is not None:
            offers = attribute_offers(cursor, token.tag)
            return chosen(offers, cursor, token.start, token.end)
        case _:
            return _in_text(cursor)


def _in_text(cursor: Cursor) -> Completions:
    """Complete in a value, or between tags."""
    token = cursor.token
    if cursor.segment is not None:
        return _in_segment(cursor, cursor.segment)
    if token.tag is not None and token.attribute is not None:
        offers, start, end = value_offers(cursor, token.tag, token.attribute)
        return chosen(offers, cursor, start, end)
    if token.where is Where.CONTENT and not cursor.text[token.start : cursor.index].strip():
        return chosen(tag_offers(cursor, opening="<"), cursor, cursor.index, cursor.index)
    return _nothing(cursor)


def _in_segment(cursor: Cursor, segment: Segment) -> Completions:
    if not segment.is_expression:
        offers, start, end = substitution_offers(cursor, segment)
        return chosen(offers, cursor, start, end)
    start, end = name_around(cursor)
    return chosen(expression_offers(cursor, segment), cursor, start, min(end, segment.end))


def _nothing(cursor: Cursor) -> Completions:
    here, _ = cursor.offsets(cursor.index, cursor.index)
    return Completions(here, here)


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
    """Yield a call of each macro, with the parameters that it needs."""
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
    """Return a call with the values that it must give, and a place for its blocks."""
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
    """Yield the closing tags of what is open, the innermost first."""
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
    """Yield the parameters of the macro that a tag calls."""
    for name, params, doc in _macros(cursor):
        if name != macro:
            continue
        for one in parameters_of(params):
            if one.kind == "value" and one.name not in given:
                group = _LIKELY if one.is_required else _FITTING
                documentation = parameter_documentation(doc, one.name)
                detail = "" if one.default is None else one.default
                yield _attribute(cursor, group, Kind.PARAMETER, one.name, detail, documentation)


def value_offers(cursor: Cursor, tag: Tag, attribute: Attribute) -> tuple[list[Offer], int, int]:
    """Return the completions in a value, and the part of it that they replace."""
    if cursor.text[cursor.index - 1 : cursor.index] == "$":
        return list(_openings(cursor)), cursor.index - 1, cursor.index
    if (tag.name, attribute.name) in FILE_ATTRIBUTES:
        return _files(cursor, attribute, FILE_ATTRIBUTES[tag.name, attribute.name])
    offers = list(_values(cursor, tag, attribute))
    return offers, attribute.start, attribute.end


def _openings(cursor: Cursor) -> Iterator[Offer]:
    """Yield what a `$` may begin."""
    following = cursor.text[cursor.index : cursor.index + 1]
    if following in {"{", "("}:
        return
    yield written(0, Kind.EXPRESSION, "${}", Snippet().write("${").stop().write("}"))
    for group, name in enumerate(("arg", "find"), 1):
        snippet = Snippet().write(f"$({name} ").stop().write(")")
        yield written(group, Kind.COMMAND, f"$({name} )", snippet)


def _values(cursor: Cursor, tag: Tag, attribute: Attribute) -> Iterator[Offer]:
    key = (tag.name, attribute.name)
    own = tag.name.removeprefix("xacro:")
    for group, value in enumerate((*VALUES.get(key, ()), *XACRO_VALUES.get((own, key[1]), ()))):
        yield plain(group, Kind.VALUE, value)
    if key in PART_REFERENCES:
        yield from _parts(cursor, PART_REFERENCES[key])
    if key == ("xacro:insert_block", "name"):
        yield from _blocks(cursor)
    if key == ("xacro:call", "macro"):
        yield from _macro_names(cursor)
    yield from _switches(cursor, own, attribute.name)


def _parts(cursor: Cursor, tag: str) -> Iterator[Offer]:
    """Yield links or joints: as this file writes them, then as they came out."""
    kind = Kind(tag)
    definitions = cursor.reading.definitions
    if definitions is None:
        return
    tree = definitions.trace.trees.get(cursor.file)
    for element in tree.elements if tree else ():
        if element.tag == tag and (name := element.attributes.get("name")):
            yield plain(0, kind, name)
    for part, name in definitions.parts:
        if part == tag:
            yield plain(1, kind, name)


def _blocks(cursor: Cursor) -> Iterator[Offer]:
    if cursor.macro is not None:
        for one in parameters_of(cursor.written(cursor.macro, "params")):
            if one.kind != "value":
                yield plain(0, Kind.BLOCK, one.name)
    for scope in cursor.scopes()[:1]:
        for name in scope.all_names():
            if name.startswith("*"):
                yield plain(1, Kind.BLOCK, name.lstrip("*"))


def _macro_names(cursor: Cursor) -> Iterator[Offer]:
    definitions = cursor.reading.definitions
    for name, _ in definitions.macros if definitions else ():
        yield plain(0, Kind.MACRO, name)


def _switches(cursor: Cursor, macro: str, name: str) -> Iterator[Offer]:
    """True and false for a parameter that is one of them when it is not given."""
    definitions = cursor.reading.definitions
    for element in definitions.macros_by_name.get(macro, ()) if definitions else ():
        for one in parameters_of(element.attributes.get("params", "")):
            if one.name == name and (one.default or "").lower() in _BOOLEANS:
                yield from (plain(group, Kind.VALUE, text) for group, text in enumerate(_BOOLEANS))


def _files(
    cursor: Cursor, attribute: Attribute, endings: tuple[str, ...]
) -> tuple[list[Offer], int, int]:
    """Return files and folders below the folder that is typed so far, or packages to begin with."""
    typed = cursor.text[attribute.start : cursor.index]
    folder, slash, _ = typed.rpartition("/")
    start = attribute.start + len(folder) + len(slash)
    end = cursor.text.find("/", cursor.index, attribute.end)
    end = attribute.end if end < 0 else end
    if f"{folder}{slash}" == _SCHEME:
        return list(_packages(cursor, slash="/")), start, end
    offers = list(_names(cursor, f"{folder}{slash}", endings))
    if not slash:
        offers += _beginnings(cursor)
    return offers, start, end


def _names(cursor: Cursor, folder: str, endings: tuple[str, ...]) -> Iterator[Offer]:
    """Yield files of a folder that may be named here; it must be below the served roots."""
    path = path_named(cursor.reading, folder or "./", cursor.file)
    for name, is_folder in names_in(cursor.reading, path) if path else ():
        if is_folder:
            yield plain(1, Kind.FOLDER, f"{name}/")
        elif PurePath(name).suffix.lower() in endings and name != "package.xml":
            yield plain(0, Kind.FILE, name)


def _beginnings(cursor: Cursor) -> list[Offer]:
    """Return the beginnings of a package's name; the file's own first."""
    offers: list[Offer] = []
    for name, folders in cursor.reading.policy.packages.items():
        group = 2 if any(cursor.file.startswith(f"{one}/") for one in folders) else 3
        offers.append(plain(group, Kind.PACKAGE, f"$(find {name})/"))
        if cursor.tag is not None and cursor.tag.name != "xacro:include":
            offers.append(plain(group, Kind.PACKAGE, f"{_SCHEME}{name}/"))
    return offers


def _packages(cursor: Cursor, slash: str) -> Iterator[Offer]:
    for name, folders in cursor.reading.policy.packages.items():
        is_own = any(cursor.file.startswith(f"{one}/") for one in folders)
        yield plain(0 if is_own else 1, Kind.PACKAGE, f"{name}{slash}")
