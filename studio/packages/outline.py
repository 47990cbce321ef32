"""What the top level of an XML file shows: whether it is a robot, and what it includes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final
from xml.parsers import expat

from studio.packages.lfs import LFS_REASON, is_lfs_pointer

if TYPE_CHECKING:
    from collections.abc import Callable

_PREFIX: Final = "xacro:"
"""Xacro goes by the prefix: four spellings of its namespace are in use (UR's is neither of the two
that its pages name), and it takes them all."""
_NAMESPACES: Final = frozenset({"http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro"})
_DIRECTIVES: Final = frozenset(
    {"arg", "property", "include", "if", "unless", "macro", "insert_block", "element", "attribute"}
)
"""Every other element with the prefix calls a macro."""
_TRANSPARENT: Final = frozenset({"if", "unless"})


@dataclass(slots=True)
class Outline:
    """The outline of one file; `error` says why it cannot be read, else is empty."""

    root: str = ""
    """Local name of the root element."""
    name: str = ""
    """The root's name attribute as written; may hold `$(arg ...)` or be empty."""
    is_xacro: bool = False
    """It declares the xacro prefix, or its namespace under any prefix; the suffix says nothing."""
    has_content: bool = False
    """A link, or a call of a macro, stands at the top level outside macros."""
    defines_macros: bool = False
    includes: list[str] = field(default_factory=list[str])
    """The file names of its includes outside macros, as written."""
    error: str = ""
    is_broken: bool = False
    """It is XML up to a fault, which is the error; the rest may be read all the same."""


def read_outline(data: bytes) -> Outline:
    """Read the outline; never raises. Entities are refused, nothing else is fetched."""
    reader = _Reader()
    try:
        reader.parse(data)
    except _RefusedError as error:
        reader.outline.error = str(error)
    except expat.ExpatError as error:
        reader.outline.error = (
            f"not well-formed XML: {expat.ErrorString(error.code)}, line {error.lineno}"
        )
        reader.outline.is_broken = True
    except (LookupError, ValueError) as error:  # an encoding that does not exist or does not fit
        reader.outline.error = f"of no readable encoding ({error})"
    return reader.outline


class _RefusedError(Exception):
    """The file asks for what is not done."""


class _DoneError(Exception):
    """Enough was seen."""


class _Reader:
    """Counts the depth and looks at what stands on the top level."""

    def __init__(self) -> None:
        self.outline = Outline()
        self._depth = 0
        """How deep below the root, elements of `_TRANSPARENT` not counted."""
        self._open: list[bool] = []
        """For each open element, whether it counts for the depth."""

    def parse(self, data: bytes) -> None:
        if not data.strip(b"\xef\xbb\xbf \t\r\n"):
            raise _RefusedError("empty")
        if is_lfs_pointer(data):
            raise _RefusedError(LFS_REASON.removesuffix("."))
        if b"\0" in data[:1024]:
            raise _RefusedError("binary or UTF-16: save it as UTF-8")
        parser: Any = expat.ParserCreate()
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.EntityDeclHandler = _refuse_entity
        parse: Callable[[bytes, bool], int] = parser.Parse
        try:
            parse(data, True)  # noqa: FBT003 - expat takes it by position only
        except _DoneError:
            return

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._see_declarations(attributes)
        in_xacro = tag.startswith(_PREFIX)
        local = tag.removeprefix(_PREFIX)
        counts = not (in_xacro and local in _TRANSPARENT)
        if not self._open:
            self._root(tag, attributes)
        elif self._depth == 1 and counts:
            self._top_level(local, attributes, in_xacro=in_xacro)
        self._open.append(counts)
        self._depth += counts

    def _see_declarations(self, attributes: dict[str, str]) -> None:
        if not self.outline.is_xacro and attributes:
            named = "xmlns:xacro" in attributes
            self.outline.is_xacro = named or not _NAMESPACES.isdisjoint(attributes.values())

    def _end(self, _full_name: str) -> None:
        self._depth -= self._open.pop()

    def _root(self, tag: str, attributes: dict[str, str]) -> None:
        self.outline.root, self.outline.name = tag, attributes.get("name", "")
        if tag != "robot":
            raise _DoneError

    def _top_level(self, local: str, attributes: dict[str, str], *, in_xacro: bool) -> None:
        outline = self.outline
        if not in_xacro:
            outline.has_content |= local == "link"
            if outline.has_content and not outline.is_xacro:
                raise _DoneError  # plain URDF: it includes nothing
        elif local == "include":
            outline.includes.append(attributes.get("filename", ""))
        elif local == "macro":
            outline.defines_macros = True
        elif local not in _DIRECTIVES:
            outline.has_content = True


def _refuse_entity(*_declaration: object) -> None:
    raise _RefusedError("it declares entities, which are never expanded")
