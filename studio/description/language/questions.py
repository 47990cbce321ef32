"""An editor's questions about a text, and the answers: outline, meanings, references, completions.

The text is as it is in the editor, broken or not; values are those of the last run that worked.
`offset`, `start` and `end` count UTF-16 code units of the editor's text (no
byte order mark, every line break one LF), from 0; so do the columns of places, from 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Final, TypeAlias


class SubjectKind(StrEnum):
    """Kind of the thing at a place in a text."""

    PROPERTY = "property"
    ARG = "arg"
    PARAMETER = "parameter"
    BLOCK = "block"
    MACRO = "macro"
    NAMESPACE = "namespace"
    """Of an include with `ns=`."""
    PACKAGE = "package"
    FILE = "file"
    FOLDER = "folder"
    YAML = "yaml"
    """A key of a YAML file."""
    FUNCTION = "function"
    CONSTANT = "constant"
    VARIABLE = "variable"
    """The name of a loop inside an expression."""
    ENVIRONMENT = "environment"
    COMMAND = "command"
    """Of a substitution: `find` of `$(find package)`."""
    LINK = "link"
    JOINT = "joint"
    EXPRESSION = "expression"
    """A `${...}` or `$(...)` as a whole."""
    TAG = "tag"
    """An element of xacro itself; `name` without its prefix."""
    ELEMENT = "element"
    ATTRIBUTE = "attribute"
    VALUE = "value"
    """A value that an attribute may have, such as `revolute`."""


@dataclass(frozen=True, slots=True)
class TextPlace:
    """A stretch of one line of a text; `line` and `column` from 1, `length` in code units."""

    file: str
    line: int
    column: int
    length: int = 0


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of a macro."""

    name: str
    """Without its stars."""
    kind: str
    """`value`, `block` (one element of the call) or `blocks` (the content of one)."""
    default: str | None
    """As written; None: a call must give it, or it is forwarded."""
    forwards: bool
    """Whether it takes the value of the same name where the macro is called (`:=^`)."""

    @property
    def is_required(self) -> bool:
        """Whether a call must give it."""
        return self.default is None and not self.forwards


@dataclass(frozen=True, slots=True)
class OutlineFile:
    """A file of the run. `inside`: number of the file that brings it in, -1 for the entry."""

    file: str
    inside: int
    place: TextPlace | None
    """The element that brings it in."""
    namespace: str
    is_yaml: bool


@dataclass(frozen=True, slots=True)
class OutlineMacro:
    """A macro of the files of the run; `name` with its namespace."""

    name: str
    parameters: tuple[Parameter, ...]
    place: TextPlace
    doc: str
    calls: int
    """In this run."""
    called_at: tuple[TextPlace, ...]
    """The first few places."""


@dataclass(frozen=True, slots=True)
class OutlineValue:
    """A property or arg of the files of the run."""

    kind: SubjectKind
    name: str
    place: TextPlace
    text: str
    values: tuple[str, ...]
    """Its values; none when this run did not evaluate it."""
    doc: str


@dataclass(frozen=True, slots=True)
class Outline:
    """Outline of the files of a run; `is_current`: the texts have not changed since."""

    files: tuple[OutlineFile, ...]
    macros: tuple[OutlineMacro, ...]
    values: tuple[OutlineValue, ...]
    is_current: bool


@dataclass(frozen=True, slots=True)
class Meaning:
    """The meaning of a name; [start, end) is the name."""

    kind: SubjectKind
    name: str
    start: int
    end: int
    text: str = ""
    """As it is written where it is defined."""
    values: tuple[str, ...] = ()
    """Its values in the run; several when it was evaluated for several calls."""
    unit: str = ""
    doc: str = ""
    places: tuple[TextPlace, ...] = ()
    """Where it is defined."""
    target: str = ""
    """The file or folder that it names."""
    parameters: tuple[Parameter, ...] = ()
    calls: int = 0
    """How often a macro was called."""
    expression: str = ""
    """The `${...}` around the name, and its value here."""
    expression_values: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class LookedUp:
    """Answer to a look-up; None: nothing known is there."""

    meaning: Meaning | None


@dataclass(frozen=True, slots=True)
class Reference:
    """A place that names a thing; `line` is its line of text."""

    place: TextPlace
    line: str
    is_definition: bool
    in_run: bool
    """Whether the run evaluated it; else found by text, and may mean another of that name."""


@dataclass(frozen=True, slots=True)
class References:
    """All places that name a thing, file by file, top to bottom; the first of `count`."""

    kind: SubjectKind | None
    name: str
    references: tuple[Reference, ...]
    count: int


@dataclass(frozen=True, slots=True)
class Completion:
    """Something that may be typed; `stops` are stretches of `insert` that the cursor visits."""

    label: str
    kind: SubjectKind
    insert: str
    stops: tuple[tuple[int, int], ...] = ()
    detail: str = ""
    doc: str = ""


@dataclass(frozen=True, slots=True)
class Completions:
    """Completions for [start, end), the likeliest first."""

    start: int
    end: int
    items: tuple[Completion, ...] = ()
    is_whole: bool = True
    """Whether nothing was left out: further typing only narrows it."""


@dataclass(frozen=True, slots=True)
class OutlineQuery:
    """Asks for the outline of the run's files."""


@dataclass(frozen=True, slots=True)
class LookUpQuery:
    """Asks for the meaning at a place; `text` is the file's content in the editor."""

    file: str
    text: bytes
    offset: int


@dataclass(frozen=True, slots=True)
class ReferencesQuery:
    """Asks for the places that use the name at a place."""

    file: str
    text: bytes
    offset: int


@dataclass(frozen=True, slots=True)
class CompletionQuery:
    """Asks for the completions at a place."""

    file: str
    text: bytes
    offset: int


@dataclass(frozen=True, slots=True)
class RenamingQuery:
    """Asks for what has to change for the name at a place to become `name`."""

    file: str
    text: bytes
    offset: int
    name: str


@dataclass(frozen=True, slots=True)
class RenamedPlace:
    """One place of a renaming; the bytes [start, end) of its file are the old name."""

    place: TextPlace
    line: str
    in_run: bool
    """Whether the run evaluated it; else it was found in the text alone."""
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class Renaming:
    """All places that change with a name, file by file, top to bottom."""

    kind: SubjectKind
    old: str
    new: str
    places: tuple[RenamedPlace, ...]


LanguageQuery: TypeAlias = (
    OutlineQuery | LookUpQuery | ReferencesQuery | CompletionQuery | RenamingQuery
)
LanguageReply: TypeAlias = Outline | LookedUp | References | Completions | Renaming

LANGUAGE_QUERIES: Final = (
    OutlineQuery,
    LookUpQuery,
    ReferencesQuery,
    CompletionQuery,
    RenamingQuery,
)
LANGUAGE_REPLIES: Final = (Outline, LookedUp, References, Completions, Renaming)
