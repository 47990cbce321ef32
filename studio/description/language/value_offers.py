"""What the value of an attribute may be, outside of expressions: files, names of parts, words."""

from __future__ import annotations

from pathlib import PurePath
from typing import TYPE_CHECKING, Final

from studio.description.language.definitions import parameters_of
from studio.description.language.named_files import names_in, path_named
from studio.description.language.offers import Offer, Snippet, plain, written
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.words import (
    FILE_ATTRIBUTES,
    PART_REFERENCES,
    VALUES,
    XACRO_VALUES,
)

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.language.cursor import Cursor
    from studio.description.language.token_at import Attribute, Tag

_BOOLEANS: Final = ("true", "false")
_SCHEME: Final = "package://"


def value_offers(cursor: Cursor, tag: Tag, attribute: Attribute) -> tuple[list[Offer], int, int]:
    """What may be typed in a value, and the part of it that this takes the place of."""
    if cursor.text[cursor.index - 1 : cursor.index] == "$":
        return list(_openings(cursor)), cursor.index - 1, cursor.index
    if (tag.name, attribute.name) in FILE_ATTRIBUTES:
        return _files(cursor, attribute, FILE_ATTRIBUTES[tag.name, attribute.name])
    offers = list(_words(cursor, tag, attribute))
    return offers, attribute.start, attribute.end


def _openings(cursor: Cursor) -> Iterator[Offer]:
    """What a `$` may begin."""
    following = cursor.text[cursor.index : cursor.index + 1]
    if following in {"{", "("}:
        return
    yield written(0, Kind.EXPRESSION, "${}", Snippet().write("${").stop().write("}"))
    for group, name in enumerate(("arg", "find"), 1):
        snippet = Snippet().write(f"$({name} ").stop().write(")")
        yield written(group, Kind.COMMAND, f"$({name} )", snippet)


def _words(cursor: Cursor, tag: Tag, attribute: Attribute) -> Iterator[Offer]:
    key = (tag.name, attribute.name)
    own = tag.name.removeprefix("xacro:")
    for group, word in enumerate((*VALUES.get(key, ()), *XACRO_VALUES.get((own, key[1]), ()))):
        yield plain(group, Kind.VALUE, word)
    if key in PART_REFERENCES:
        yield from _parts(cursor, PART_REFERENCES[key])
    if key == ("xacro:insert_block", "name"):
        yield from _blocks(cursor)
    if key == ("xacro:call", "macro"):
        yield from _macro_names(cursor)
    yield from _switches(cursor, own, attribute.name)


def _parts(cursor: Cursor, tag: str) -> Iterator[Offer]:
    """Links or joints: as this file writes them, then as they came out."""
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
    """Files and folders below the folder that is typed so far, or packages to begin with."""
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
    """What a folder holds that may be named here; it must lie below the served roots."""
    path = path_named(cursor.reading, folder or "./", cursor.file)
    for name, is_folder in names_in(cursor.reading, path) if path else ():
        if is_folder:
            yield plain(1, Kind.FOLDER, f"{name}/")
        elif PurePath(name).suffix.lower() in endings and name != "package.xml":
            yield plain(0, Kind.FILE, name)


def _beginnings(cursor: Cursor) -> list[Offer]:
    """The ways to name a package; the file's own first."""
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
