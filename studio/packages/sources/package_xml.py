"""A package.xml as it is written: its elements with their bytes, up to a fault."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final
from xml.parsers import expat

from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES, package_name
from studio.packages.sources.spans import SourceText

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["DEPENDENCY_TAGS", "FILE_NAME", "SIZE_LIMIT_BYTES", "TAGS", "Element", "PackageXml"]

DEPENDENCY_TAGS: Final = (
    "buildtool_depend",
    "buildtool_export_depend",
    "depend",
    "build_depend",
    "build_export_depend",
    "exec_depend",
    "run_depend",
    "test_depend",
    "doc_depend",
)
"""Source: REP 149 (package format 3); `run_depend` is of format 1."""
TAGS: Final = (
    *("name", "version", "description", "maintainer", "license", "url", "author"),
    *DEPENDENCY_TAGS,
    *("conflict", "replace", "group_depend", "member_of_group", "export"),
)
"""Of what stands right below `package`, in the order in which it is written."""
ELEMENTS_MAX: Final = 5_000
_DEPTH_MAX: Final = 50


@dataclass(slots=True)
class Element:
    """One element; `end` is behind its closing tag. `text` is stripped, of itself alone."""

    tag: str
    parents: tuple[str, ...]
    attributes: dict[str, str]
    start: int
    inner_start: int
    inner_end: int = 0
    end: int = 0
    text: str = ""
    line: int = 0


class PackageXml:
    """What can be read of a package.xml; entities are refused."""

    def __init__(self, file: str, data: bytes) -> None:
        self.source = SourceText(file, data)
        self.elements: list[Element] = []
        """Whole ones, in the order in which they begin."""
        self.fault = ""
        """Why the rest was not read, as the end of a sentence."""
        self.fault_line = 0
        self._open: list[Element] = []
        self._refused = False
        self._read(data)
        self.elements.sort(key=lambda one: one.start)

    @property
    def name(self) -> str:
        """The name of the package; empty if there is no valid one."""
        return package_name(self.source.data) or ""

    def of(self, *tags: str) -> list[Element]:
        """Return the elements with one of these tags right below `package`."""
        return [one for one in self.elements if one.tag in tags and one.parents == ("package",)]

    def text_of(self, tag: str) -> str:
        """Return the text of the first such element; empty if there is none."""
        return next((one.text for one in self.of(tag)), "")

    def dependencies(self) -> list[Element]:
        """Return every element that names a package that is depended on."""
        return self.of(*DEPENDENCY_TAGS)

    def build_type(self) -> str:
        """Return the build type that it exports, as written; empty if it exports none."""
        return self.build_type_element.text if self.build_type_element else ""

    @property
    def build_type_element(self) -> Element | None:
        """The exported build type."""
        exported = (
            one
            for one in self.elements
            if one.tag == "build_type" and one.parents == ("package", "export")
        )
        return next(exported, None)

    @property
    def closing(self) -> int | None:
        """Where `</package>` begins; None: it is not closed."""
        whole = (one for one in self.elements if one.tag == "package" and not one.parents)
        found = next(whole, None)
        return found.inner_end if found and not self.fault else None

    def groups(self) -> list[str]:
        """Return the groups of packages that it is a member of."""
        return [one.text for one in self.of("member_of_group")]

    def _read(self, data: bytes) -> None:
        parser = expat.ParserCreate()
        parser.buffer_text = True

        def start(tag: str, attributes: dict[str, str]) -> None:
            at = parser.CurrentByteIndex
            if len(self.elements) + len(self._open) >= ELEMENTS_MAX or len(self._open) > _DEPTH_MAX:
                self._refuse("has more elements than any package needs")
            parents = tuple(one.tag for one in self._open)
            inner = _tag_end(data, at)
            line = self.source.line_of(at)
            self._open.append(Element(tag, parents, attributes, at, inner, line=line))

        def end(_tag: str) -> None:
            one = self._open.pop()
            at = parser.CurrentByteIndex
            is_empty = data[one.inner_start - 2 : one.inner_start] == b"/>"
            one.inner_end = one.inner_start if is_empty else at
            one.end = one.inner_start if is_empty else _tag_end(data, at)
            one.text = one.text.strip()
            self.elements.append(one)

        def text(letters: str) -> None:
            if self._open:
                self._open[-1].text += letters

        def entity(*_declaration: object) -> None:
            self._refuse("declares entities, which are never expanded")

        parser.StartElementHandler = start
        parser.EndElementHandler = end
        parser.CharacterDataHandler = text
        parser.EntityDeclHandler = entity
        try:
            parser.Parse(data, True)  # noqa: FBT003 - expat takes it by position only
        except _RefusedError as error:
            self.fault, self.fault_line = str(error), 1
        except expat.ExpatError as error:
            self.fault, self.fault_line = expat.ErrorString(error.code), error.lineno
        except (LookupError, ValueError) as error:
            self.fault, self.fault_line = f"is of no readable encoding ({error})", 1

    def _refuse(self, reason: str) -> None:
        raise _RefusedError(reason)

    def open_at_fault(self) -> Iterator[Element]:
        """Yield the elements that were not closed when the fault was met, the outermost first."""
        yield from self._open


class _RefusedError(Exception):
    """The file is not read further."""


def _tag_end(data: bytes, at: int) -> int:
    """Return where the tag that begins at `at` ends, behind its `>`."""
    quote = 0
    for index in range(at, len(data)):
        letter = data[index]
        if quote:
            quote = 0 if letter == quote else quote
        elif letter in b"\"'":
            quote = letter
        elif letter == ord(">"):
            return index + 1
    return len(data)
