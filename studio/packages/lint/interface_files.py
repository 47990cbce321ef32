"""Checks of the texts of messages, services and actions, and of their names."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.packages.lint.checked import ERROR, edit, found
from studio.packages.sources.interfaces import interface_files

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.spans import SourceText
    from studio.problems import Problem

_PARTS: Final = {"msg": 0, "srv": 1, "action": 2}
_FIELD: Final = r"[A-Za-z][\w/]*(?:<=\d+)?(?:\[(?:<=)?\d*\])?[ \t]+[A-Za-z]\w*"
_SEVERAL: Final = re.compile(rf"{_FIELD}(?:(?:[ \t]*[,;])?[ \t]+{_FIELD})+(?:[ \t]*[,;])?")
_ONE: Final = re.compile(_FIELD)
_CAMEL: Final = re.compile(r"[A-Z][A-Za-z0-9]*")
_SNAKE: Final = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield what keeps each file from being a type."""
    source = checked.source
    for kind, name in interface_files(source):
        text = source.text(name)
        if text is None or name.count("/") != 1:
            continue
        stem = name.rpartition("/")[2].removesuffix(f".{kind}")
        if not _CAMEL.fullmatch(stem):
            yield _badly_named(text, stem, kind)
            continue
        special = [*_lines(text), *_parts(text, kind)]
        yield from special
        fault = checked.known.type_fault(f"{source.name}/{kind}/{stem}", text.text)
        if fault is not None and not special:
            at = text.offset(fault.line) if fault.line else 0
            yield found(ERROR, "interface-text", fault.sentence, text, at)


def _badly_named(text: SourceText, stem: str, kind: str) -> Problem:
    parts = re.split(r"[^A-Za-z0-9]+", stem)
    right = "".join(one[:1].upper() + one[1:] for one in parts).lstrip("0123456789")
    hint = f": call the file {right}.{kind}" if right else ""
    sentence = f'"{stem}" is no name for a type, which is in letters, a capital first{hint}.'
    return found(ERROR, "interface-name", sentence, text)


def _lines(text: SourceText) -> Iterator[Problem]:
    at = 0
    for raw in text.data.splitlines(keepends=True):
        begin, at = at, at + len(raw)
        line = raw.decode("utf-8", "replace")
        code = line.partition("#")[0].rstrip()
        start = begin + len(line[: len(line) - len(line.lstrip())].encode())
        written = code.strip()
        if not written or written == "---" or len(code) > 2_000:
            continue
        if "=" not in written.replace("<=", "") and _SEVERAL.fullmatch(written):
            rows = _ONE.findall(written)
            indent = code[: len(code) - len(code.lstrip())]
            lines = f"{text.line_break}{indent}".join(rows)
            change = text.replaced(start, start + len(written.encode()), lines)
            mend = edit("One field a line", change)
            sentence = f'"{written[:80]}" holds {len(rows)} fields: each has a line of its own.'
            yield found(ERROR, "interface-several-fields", sentence, text, start, mend)
            continue
        words = written.split()
        if len(words) == 2 and words[1].endswith((",", ";", ".")):
            end = start + len(written.encode())
            mend = edit(f"Remove {words[1][-1]}", text.replaced(end - 1, end, ""))
            sentence = f'No "{words[1][-1]}" stands behind a field: "{written[:-1]}".'
            yield found(ERROR, "interface-punctuation", sentence, text, start, mend)
        elif len(words) >= 2 and "=" not in written and _is_misnamed(words[1]):
            right = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", words[1]).lower()
            right = re.sub(r"__+", "_", right).strip("_")
            offset = start + len(written[: written.index(words[1], len(words[0]))].encode())
            change = text.replaced(offset, offset + len(words[1].encode()), right)
            sentence = f'The field "{words[1]}" is named in small letters and "_": {right}.'
            mend = edit(f"Write {right}", change)
            yield found(ERROR, "interface-field-name", sentence, text, start, mend)


def _is_misnamed(field: str) -> bool:
    return bool(re.fullmatch(r"[A-Za-z]\w*", field)) and not _SNAKE.fullmatch(field)


def _parts(text: SourceText, kind: str) -> Iterator[Problem]:
    rules = [
        number
        for number, line in enumerate(text.text.splitlines(), start=1)
        if re.fullmatch(r"-{3,}\s*", line.partition("#")[0].strip() or "x")
    ]
    wanted = _PARTS[kind]
    if len(rules) == wanted:
        return
    what = {
        "msg": "A message has one part: no line of --- belongs in it.",
        "srv": "A service has a request and a response, with one line of --- between them.",
        "action": (
            "An action has a goal, a result and a feedback, with a line of --- between each two: "
            "fields of the feedback stand below the second."
        ),
    }[kind]
    at = text.offset(rules[wanted]) if len(rules) > wanted else 0
    mend = None
    missing = wanted - len(rules)
    if missing > 0 and text.data.strip() and kind != "msg":
        eol = text.line_break
        lead = "" if text.data.endswith(b"\n") else eol
        mend = edit("Add ---", text.put_in(len(text.data), lead + f"---{eol}" * missing))
    yield found(ERROR, "interface-parts", what, text, at, mend)


WHY: Final = {
    "interface-name": {
        "en": "The file's name is that of the type, and of a class: rosidl refuses others.",
        "de": "Der Dateiname ist der Name des Typs und einer Klasse: rosidl weist andere ab.",
    },
    "interface-text": {
        "en": "No code is made of a text that breaks a rule, and the build stops.",
        "de": "Aus einem Text, der eine Regel verletzt, entsteht kein Code; der Bau bricht ab.",
    },
    "interface-several-fields": {
        "en": "A line is read as one field: its type, its name and perhaps a default.",
        "de": "Eine Zeile ist genau ein Feld: Typ, Name und vielleicht ein Vorgabewert.",
    },
    "interface-punctuation": {
        "en": "Lines of interfaces end with the name of the field.",
        "de": "Zeilen von Interfaces enden mit dem Namen des Felds.",
    },
    "interface-field-name": {
        "en": "rosidl refuses field names with capitals.",
        "de": "rosidl weist Feldnamen mit Großbuchstaben ab.",
    },
    "interface-parts": {
        "en": "The lines of --- say where one part ends and the next one begins.",
        "de": "Die Zeilen mit --- sagen, wo ein Teil endet und der nächste beginnt.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
