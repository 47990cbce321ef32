"""Variants of a description: texts by what a person would call them, found again in changed files.

A name outlives edits elsewhere, which byte offsets and element counts do not. All that is asked of
a file is its bytes: a variant can be applied to files that the last run did not read.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from studio.description.editing.splice import apply, edit_at
from studio.description.sites.drafts import FileDrafts, draft_xml, draft_yaml
from studio.description.syntax.source_tree import SourceError, parse_source
from studio.description.values import Edit, SiteKind
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.sites.drafts import Draft

_YAML_ENDINGS = (".yaml", ".yml")
_BOM = b"\xef\xbb\xbf"


@dataclass(frozen=True, slots=True, order=True)
class TextName:
    """Which text of a description is meant."""

    file: str
    """Relative to the folder of the entry file with `/` between, or `package://<name>/<path>`."""
    kind: SiteKind
    name: str
    """As `Site.name`: of a property or argument, a key path, an element path with its attribute."""
    within: str = ""
    """The macro of a parameter default; the link, joint or macro around a plain number."""
    number: int = 1
    """Counts the texts of the file that are called the same."""

    def __str__(self) -> str:
        shown = f"{self.within} {self.name}" if self.within else self.name
        return f"{shown} ({self.number})" if self.number > 1 else shown


@dataclass(frozen=True, slots=True)
class Variant:
    """A named set of arguments and texts, on top of what the files say."""

    name: str
    note: str = ""
    arguments: dict[str, str | None] = field(default_factory=dict[str, "str | None"])
    """Passed to xacro; None takes back one that the document was opened with."""
    texts: dict[TextName, str] = field(default_factory=dict[TextName, str])


@dataclass(frozen=True, slots=True)
class Placed:
    """What texts come to in one file: edits, the last place first, and what found no place."""

    edits: tuple[Edit, ...]
    left_out: tuple[str, ...] = ()


class NamedTexts:
    """The editable texts of one file as the disk has it, by name.

    Args:
        file: As in `TextName.file`.
        path: Where it lies.
        disk: Its bytes there.
    """

    def __init__(self, file: str, path: str, disk: bytes) -> None:
        self.file, self.path, self.disk = file, path, disk
        self._saved = _drafts(path, disk, None)
        self._now = self._saved
        self._names: dict[bytes, dict[TextName, Draft]] = {disk: _named(file, self._saved)}

    def has_read(self, now: bytes) -> bool:
        """Whether the texts of these bytes are known, so that asking for them takes no time."""
        return now in self._names

    def read(self, now: bytes) -> None:
        """Read the texts of these bytes, if they are not known."""
        self._at(now)

    def saved_text(self, name: TextName) -> str | None:
        """What the disk says; None when it has no such text."""
        found = self._names[self.disk].get(name)
        return found.text if found else None

    def line_of(self, name: TextName) -> int:
        """The line (from 1) where the disk has a text; 0 when it has none."""
        found = self._names[self.disk].get(name)
        return found.place.line if found else 0

    def differing(self, now: bytes) -> dict[TextName, str]:
        """The texts of an edited file that say something else than the disk does."""
        saved = self._names[self.disk]
        return {
            name: draft.text
            for name, draft in self._at(now).items()
            if name in saved and saved[name].text != draft.text
        }

    def edits_to(self, now: bytes, texts: Mapping[TextName, str]) -> Placed:
        """What makes an edited file say these texts, and everywhere else what the disk says."""
        here, edits, left_out = self._at(now), list[Edit](), list[str]()
        saved = {name: draft.text for name, draft in self._names[self.disk].items()}
        wanted = {**saved, **texts}
        for name, text in wanted.items():
            draft = here.get(name)
            if draft is None:
                if name in texts:
                    left_out.append(f"{self.file} has no {_words(name)} any more.")
            elif draft.text != text:
                try:
                    edits.append(edit_at(self.path, now, draft.span, text))
                except EditError as error:
                    left_out.append(f"{self.file}, {_words(name)}: {error}")
        edits.sort(key=lambda edit: edit.start, reverse=True)
        return Placed(tuple(edits), tuple(left_out))

    def with_texts(self, texts: Mapping[TextName, str]) -> tuple[bytes, tuple[str, ...]]:
        """The disk's bytes with these texts in them, and what found no place."""
        placed = self.edits_to(self.disk, texts)
        return apply(self.disk, placed.edits), placed.left_out

    def _at(self, now: bytes) -> dict[TextName, Draft]:
        """The texts of other bytes; those of the disk's and of the last ones are kept."""
        known = self._names.get(now)
        if known is None:
            known = _named(self.file, _drafts(self.path, now, self._saved))
            self._names = {self.disk: self._names[self.disk], now: known}
        return known


def differing_names(one: Mapping[TextName, str], other: Mapping[TextName, str]) -> list[TextName]:
    """Names of texts that two sets do not both have alike, in order."""
    return sorted(name for name in {**one, **other} if one.get(name) != other.get(name))


def _drafts(path: str, data: bytes, before: FileDrafts | None) -> FileDrafts:
    """The texts of a file; none while it cannot be read as what it is."""
    if path.lower().endswith(_YAML_ENDINGS):
        return draft_yaml(path, data)
    try:
        return draft_xml(parse_source(path, data), before)
    except SourceError:
        is_markup = data.removeprefix(_BOM).lstrip().startswith(b"<")
        return FileDrafts(data, ()) if is_markup else draft_yaml(path, data)


def _named(file: str, drafts: FileDrafts) -> dict[TextName, Draft]:
    seen: Counter[tuple[SiteKind, str, str]] = Counter()
    found: dict[TextName, Draft] = {}
    for draft in drafts.drafts:
        around = draft.kind in (SiteKind.LITERAL, SiteKind.PARAM_DEFAULT)
        key = (draft.kind, draft.name, draft.group if around else "")
        seen[key] += 1
        found[TextName(file, *key, seen[key])] = draft
    return found


def _words(name: TextName) -> str:
    kinds = {
        SiteKind.ARG: "argument",
        SiteKind.PROPERTY: "property",
        SiteKind.YAML: "key",
        SiteKind.PARAM_DEFAULT: "parameter",
        SiteKind.LITERAL: "number",
    }
    return f"{kinds[name.kind]} {name}"


def texts_by_file(texts: Mapping[TextName, str]) -> dict[str, dict[TextName, str]]:
    """The same, file by file."""
    found: dict[str, dict[TextName, str]] = {}
    for name, text in texts.items():
        found.setdefault(name.file, {})[name] = text
    return found
