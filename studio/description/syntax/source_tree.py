"""The tree of one XML source file: raw attributes, and where each element stands in the bytes.

Unlike DOM parsers it keeps line, column and byte offset, so that a text can be edited where it is
written. A file is hostile until shown otherwise: entity declarations are refused, size and depth
are bounded.
"""

from __future__ import annotations

import codecs
import re
from typing import TYPE_CHECKING
from xml.parsers import expat

from studio.description.syntax.xml_faults import cause_of, sentence_of
from studio.errors import EditError
from studio.files import LFS_REASON, is_lfs_pointer
from studio.problems import Place
from studio.settings import SOURCE_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Iterator
    from typing import TypeAlias

XACRO_NAMESPACES = frozenset({"http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro"})
DEPTH_LIMIT = 256
"""Elements inside elements; the deepest file of the corpus has 14."""

_UTF16_MARKS = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE, b"<\0", b"\0<")
_DECLARATION = re.compile(rb"<\?xml\s")
_START_TAG = re.compile(rb"""<(?:[^"'>]|"[^"]*"|'[^']*')*>""")
OUTSIDE_XML = re.compile(rb"[\0-\x08\x0b\x0c\x0e-\x1f]")
"""Bytes that no XML holds."""
_IMPLIED_PREFIXES = frozenset({"xml", "xmlns"})


class SourceError(Exception):
    """A text is no XML that may be read; `sentence` has the reason and advice. 1-based place."""

    def __init__(self, code: str, sentence: str, place: Place) -> None:
        super().__init__(f"{place}: {sentence}")
        self.code, self.sentence, self.place = code, sentence, place


class SourceText:
    """Text between tags; `literal` for a CDATA section, which xacro does not evaluate."""

    __slots__ = ("literal", "text")

    def __init__(self, text: str, *, literal: bool = False) -> None:
        self.text, self.literal = text, literal


class SourceComment:
    """A comment and the byte offset of its `<`; its text without the dashes."""

    __slots__ = ("line", "offset", "text")

    def __init__(self, text: str, line: int, offset: int) -> None:
        self.text, self.line, self.offset = text, line, offset


class SourceElement:
    """One element as written. Compared by identity; `ordinal` counts start tags from 0.

    `attributes` are raw (only XML's own references resolved) in written order, xmlns included.
    `place` is where its `<` stands, in characters; `offset` is the byte of it.
    `end_tag` is the byte of its end tag, or behind its `/>`; -1 where a broken text has none.
    """

    __slots__ = (
        "attributes",
        "children",
        "end_tag",
        "offset",
        "ordinal",
        "parent",
        "place",
        "plan",
        "tag",
        "tree",
    )

    def __init__(
        self, tree: SourceTree, parent: SourceElement | None, tag: str, place: Place
    ) -> None:
        self.tree, self.parent, self.tag, self.place = tree, parent, tag, place
        self.attributes: dict[str, str] = {}
        self.children: list[SourceNode] = []
        self.offset = self.ordinal = 0
        self.end_tag = -1
        self.plan: object | None = None
        """What the evaluator keeps about this element between runs."""

    @property
    def origin(self) -> SourceElement:
        """Itself: so that evaluated and written elements are asked alike."""
        return self

    @property
    def xacro_name(self) -> str | None:
        """`property` for `xacro:property`; None for an ordinary element."""
        return self.tag[6:] if self.tag.startswith("xacro:") else None

    @property
    def line(self) -> int:
        """The line of its place."""
        return self.place.line

    @property
    def closes_itself(self) -> bool:
        """Whether it has no end tag, as `<a/>`."""
        return not self.children and self.tree.data[self.end_tag - 2 : self.end_tag] == b"/>"

    @property
    def inside(self) -> int:
        """The byte behind its start tag.

        Raises:
            EditError: A broken text has no sure end of it; so for `end`.
        """
        if self.closes_itself:
            return self.end_tag
        start = _START_TAG.match(self.tree.data, self.offset)
        if start is None:
            raise self._endless()
        return start.end()

    @property
    def end(self) -> int:
        """The byte behind its end tag; errors as for `inside`."""
        if self.end_tag < 0:
            raise self._endless()
        return self.end_tag if self.closes_itself else self.tree.data.index(b">", self.end_tag) + 1

    def _endless(self) -> EditError:
        return EditError(f"{self.place}: the end of this element was not found: reload the file.")

    def elements(self) -> Iterator[SourceElement]:
        """Yield its child elements, in order."""
        return (child for child in self.children if isinstance(child, SourceElement))

    def __repr__(self) -> str:
        return f"<{self.tag}> {self.place}"


if TYPE_CHECKING:
    SourceNode: TypeAlias = SourceElement | SourceText | SourceComment


class SourceTree:
    """One parsed file: `elements[n].ordinal == n`. Made by `parse_source`, not changed after."""

    __slots__ = ("comments", "data", "elements", "encoding", "path", "root", "uses_xacro")

    def __init__(self, path: str, data: bytes, encoding: str) -> None:
        self.path, self.data, self.encoding = path, data, encoding
        self.elements: list[SourceElement] = []
        self.comments: list[SourceComment] = []
        """All comments inside the root, in order."""
        self.uses_xacro = False
        """Whether it declares xacro's namespace, in either spelling."""
        self.root: SourceElement


def parse_source(path: str, data: bytes) -> SourceTree:
    """Parse the bytes of one file; `path` is only named in errors and places.

    UTF-8 (with or without BOM) as xacro reads it, else the encoding that the file declares.

    Raises:
        SourceError: Empty, too large, binary, UTF-16, not well-formed, or it declares entities.
    """
    _refuse_what_is_no_text(path, data)
    tree = blank_tree(path, data)
    _Builder(tree).parse()
    return tree


def blank_tree(path: str, data: bytes) -> SourceTree:
    """Return a tree without elements, for another reader of the bytes.

    Raises:
        SourceError: They are not of the encoding that they declare.
    """
    return SourceTree(path, data, _encoding_of(path, data))


def _refuse_what_is_no_text(path: str, data: bytes) -> None:
    def refuse(code: str, sentence: str) -> SourceError:
        return SourceError(code, sentence, Place(path, 1, 1))

    if len(data) > SOURCE_SIZE_LIMIT_BYTES:
        limit_mb = SOURCE_SIZE_LIMIT_BYTES >> 20
        raise refuse("file-too-large", f"The file is larger than {limit_mb} MB and was not read.")
    if not data.strip():
        raise refuse("file-empty", "The file is empty: a robot description starts with <robot>.")
    if is_lfs_pointer(data):
        raise refuse("file-lfs-pointer", f"The file {LFS_REASON}")
    if data.startswith(_UTF16_MARKS):
        raise refuse("file-utf16", "The file is UTF-16: save it as UTF-8.")
    if OUTSIDE_XML.search(data, 0, 1 << 16):
        raise refuse("file-binary", "The file is binary, not XML: choose a .xacro or .urdf file.")
    declared = _DECLARATION.search(data)
    start = len(codecs.BOM_UTF8) if data.startswith(codecs.BOM_UTF8) else 0
    if declared and declared.start() != start and b"<" not in data[start : declared.start()]:
        raise refuse(
            "xml-not-first", "There is text or an empty line before <?xml ...?>: remove it."
        )


def _encoding_of(path: str, data: bytes) -> str:
    """Return UTF-8 if the bytes are, as xacro does; else the encoding of the XML declaration."""
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        declared = re.match(rb"\s*<\?xml[^>]*?encoding\s*=\s*[\"']([\w.:-]+)", data)
        name = declared[1].decode("ascii") if declared else "utf-8"
    else:
        return "utf-8"
    try:
        data.decode(name)
    except (LookupError, UnicodeDecodeError):
        sentence = f"The file is not {name.upper()} as it says it is: save it as UTF-8."
        raise SourceError("file-encoding", sentence, Place(path, 1, 1)) from None
    return name


class _Builder:
    """Expat's handlers for one file."""

    def __init__(self, tree: SourceTree) -> None:
        self._tree = tree
        self._open: list[SourceElement] = []
        self._prefixes: list[frozenset[str]] = [_IMPLIED_PREFIXES]
        self._in_cdata = False
        self._parser = self._make_parser()

    def _make_parser(self) -> expat.XMLParserType:
        parser = expat.ParserCreate(self._tree.encoding)
        parser.buffer_text = True
        parser.ordered_attributes = True
        parser.StartElementHandler = self._start
        parser.EndElementHandler = self._end
        parser.CharacterDataHandler = self._text
        parser.CommentHandler = self._comment
        parser.StartCdataSectionHandler = self._start_cdata
        parser.EndCdataSectionHandler = self._end_cdata
        parser.EntityDeclHandler = self._refuse_entity
        return parser

    def parse(self) -> None:
        """Fill the tree.

        Raises:
            SourceError: See `parse_source`.
        """
        try:
            self._parser.Parse(self._tree.data, True)  # noqa: FBT003 - expat's own API
        except expat.ExpatError as error:
            at = self._parser.ErrorByteIndex
            sentence = sentence_of(error, self._tree.data, at, self._open)
            raise SourceError("xml-malformed", sentence, self._place(error, at)) from None
        except ValueError:  # expat's error for encodings of more than one byte per character
            sentence = f"The encoding {self._tree.encoding} is not read: save the file as UTF-8."
            place = Place(self._tree.path, 1, 1)
            raise SourceError("file-encoding", sentence, place) from None

    def _place(self, error: expat.ExpatError, at: int) -> Place:
        """Return where the fault begins; `at` is the byte where expat stopped."""
        data, begin = self._tree.data, cause_of(error, self._tree.data, at)
        if begin == at:
            return Place(self._tree.path, error.lineno, error.offset + 1)
        line = data[:begin].rpartition(b"\n")[2]
        column = len(line.decode(self._tree.encoding, "replace")) + 1
        return Place(self._tree.path, error.lineno - data[begin:at].count(b"\n"), column)

    def _start(self, tag: str, attributes: list[str]) -> None:
        parser, tree = self._parser, self._tree
        place = Place(tree.path, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1)
        element = SourceElement(tree, self._open[-1] if self._open else None, tag, place)
        element.offset, element.ordinal = parser.CurrentByteIndex, len(tree.elements)
        element.attributes = dict(zip(attributes[::2], attributes[1::2], strict=True))
        if len(self._open) >= DEPTH_LIMIT:
            raise SourceError(
                "xml-too-deep", f"Elements are nested deeper than {DEPTH_LIMIT}.", place
            )
        if self._open:
            self._open[-1].children.append(element)
        else:
            tree.root = element
        tree.elements.append(element)
        self._open.append(element)
        self._check_prefixes(element)

    def _check_prefixes(self, element: SourceElement) -> None:
        declared = self._prefixes[-1]
        own = [name for name in element.attributes if name.startswith("xmlns:")]
        if own:
            declared = declared | {name[6:] for name in own}
            self._tree.uses_xacro |= any(element.attributes[n] in XACRO_NAMESPACES for n in own)
        self._prefixes.append(declared)
        for name in (element.tag, *element.attributes):
            prefix, colon, _ = name.partition(":")
            if colon and prefix not in declared:
                raise SourceError("xml-unbound-prefix", unbound_sentence(prefix), element.place)

    def _end(self, _tag: str) -> None:
        self._open.pop().end_tag = self._parser.CurrentByteIndex
        self._prefixes.pop()

    def _text(self, text: str) -> None:
        siblings = self._open[-1].children
        last = siblings[-1] if siblings else None
        if isinstance(last, SourceText) and last.literal == self._in_cdata:
            last.text += text  # expat hands long texts out in pieces
        else:
            siblings.append(SourceText(text, literal=self._in_cdata))

    def _comment(self, text: str) -> None:
        if self._open:
            at = self._parser
            node = SourceComment(text, at.CurrentLineNumber, at.CurrentByteIndex)
            self._open[-1].children.append(node)
            self._tree.comments.append(node)

    def _start_cdata(self) -> None:
        self._in_cdata = True

    def _end_cdata(self) -> None:
        self._in_cdata = False

    def _refuse_entity(self, name: str, *_rest: object) -> None:
        place = Place(self._tree.path, self._parser.CurrentLineNumber)
        raise SourceError(
            "xml-entity", f'The file declares the XML entity "{name}", which is not read.', place
        )


def unbound_sentence(prefix: str) -> str:
    """Return what to do about a prefix that is not declared."""
    if prefix == "xacro":
        declaration = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
        return f"xacro: is used but not declared: add {declaration} to the root element."
    return f'The prefix "{prefix}:" is not declared: add xmlns:{prefix}="..." to the root element.'
