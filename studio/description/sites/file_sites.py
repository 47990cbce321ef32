"""The sites of one file, as far as its bytes alone show them, and while edits change them.

What a run adds is in `sites`. Ids count elements, not bytes, so that they outlast every edit of a
text.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from studio.description.sites.widgets import NUMBERED_TAGS, parse_number, quantity_of_attribute
from studio.description.syntax.annotations import (
    NOTHING,
    Annotation,
    Comment,
    Entry,
    Remark,
    attach_comments,
    read_annotation,
)
from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.params import param_defaults
from studio.description.syntax.source_tree import SourceComment, SourceElement, SourceText
from studio.description.syntax.yaml_spans import YamlDocument, key_path_text, read_yaml_document
from studio.description.values import SiteKind, Span
from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Set

    from studio.description.syntax.source_tree import SourceTree
    from studio.description.syntax.yaml_spans import KeyPath
    from studio.description.values import Edit


_TEXTS = {
    "xacro:property": (SiteKind.PROPERTY, ("value", "default")),
    "xacro:arg": (SiteKind.ARG, ("default",)),
}
_AROUND = frozenset(
    {"robot", "link", "joint", "visual", "collision", "inertial", "geometry", "material"}
)
_CONDITIONS = frozenset({"xacro:if", "xacro:unless"})
_NAMED = frozenset({"link", "joint", "material"})
_VECTOR_LENGTH = 16
_TAG_UNITS = {
    "!degrees": "deg",
    "!radians": "rad",
    "!meters": "m",
    "!millimeters": "mm",
    "!foot": "ft",
    "!inches": "in",
}
_LINE_END = re.compile(rb"\n|\r(?!\n)")


@dataclass(frozen=True, slots=True)
class FileSite:
    """One editable text of a file; the fields are those of `Site`, where they are the same."""

    id: str
    kind: SiteKind
    name: str
    place: Place
    span: Span
    text: str
    group: str
    annotation: Annotation = NOTHING
    ordinal: int = -1
    """The element that holds it; -1 in YAML."""
    attribute: str = ""
    path: KeyPath = ()
    """The key path of a YAML scalar."""
    element_path: str = ""
    """Of a literal: tags from the link or joint down to its element."""
    remarks: tuple[str, ...] = ()
    """The comments that speak of it."""
    tag: str = ""
    """Of a YAML scalar, as written: `!degrees`."""

    def rewritten(self, text: str) -> FileSite:
        """Return the site when another text stands there, on the same line."""
        if not any("," in one for one in self.remarks):  # only choices are read beside the text
            return replace(self, text=text)
        if self.kind is SiteKind.YAML:
            annotation = _yaml_annotation(self.remarks, text, self.tag)
        else:
            annotation = read_annotation(self.remarks, text)
        return replace(self, text=text, annotation=annotation)


@dataclass(frozen=True, slots=True)
class FileSites:
    """All sites of one file in file order, and the bytes that they belong to."""

    data: bytes
    sites: tuple[FileSite, ...]
    aliases: tuple[tuple[KeyPath, KeyPath], ...] = field(default=())


class LiveSites:
    """The sites of a file while edits change them, each edit within one site and on its line."""

    def __init__(self, file: FileSites) -> None:
        self._sites = list(file.sites)
        self._starts = [one.span.start for one in file.sites]
        self._sizes = [one.span.end - one.span.start for one in file.sites]
        """Starts and sizes are those of the run, without what edits made them grow."""
        self._in_order = sorted(range(len(self._sites)), key=self._starts.__getitem__)
        self._growth: dict[int, int] = {}
        """How much each edited site has grown, by its index."""
        self.index_of = {site.id: index for index, site in enumerate(file.sites)}
        self.has_aliases = bool(file.aliases)

    def find(self, edit: Edit) -> int | None:
        """Return the site that an edit lies in."""
        at = bisect_right(self._in_order, edit.start, key=self._start)
        if not at:
            return None
        index = self._in_order[at - 1]
        return index if edit.end <= self._end(index) else None

    def site(self, index: int) -> FileSite:
        """Return a site as it stands now."""
        site, start, end = self._sites[index], self._start(index), self._end(index)
        if (site.span.start, site.span.end) != (start, end):
            site = self._sites[index] = replace(site, span=Span(start, end, site.span.syntax))
        return site

    def by_id(self, site_id: str) -> FileSite:
        """Return a site as it stands now, by its id."""
        return self.site(self.index_of[site_id])

    def without_span(self, site_id: str) -> FileSite:
        """Return a site as it is now by its id; its span may be an earlier one."""
        return self._sites[self.index_of[site_id]]

    def write(self, index: int, edit: Edit, text: str) -> None:
        """Replace the text of a site; those behind it move."""
        growth = len(edit.new) - (edit.end - edit.start)
        self._growth[index] = self._growth.get(index, 0) + growth
        self._sites[index] = self._sites[index].rewritten(text)

    def move_behind(self, index: int, growth: int) -> list[str]:
        """Shift the columns of what stands behind a site on its line; the ids of what moved."""
        at, line = self._starts[index], self._sites[index].place.line
        moved = [
            number
            for number, one in enumerate(self._sites)
            if one.place.line == line and self._starts[number] > at
        ]
        for number in moved:
            place = self._sites[number].place
            self._put(number, Place(place.file, line, place.column + growth))
        return [self._sites[number].id for number in moved]

    def move_elements(self, places: Mapping[int, Place]) -> list[str]:
        """Put sites where their elements are now, by ordinal; the ids of what moved."""
        moved = [number for number, one in enumerate(self._sites) if one.ordinal in places]
        for number in moved:
            self._put(number, places[self._sites[number].ordinal])
        return [self._sites[number].id for number in moved]

    def _put(self, index: int, place: Place) -> None:
        self._sites[index] = replace(self._sites[index], place=place)

    def _start(self, index: int) -> int:
        start = self._starts[index]
        before = (size for other, size in self._growth.items() if self._starts[other] < start)
        return start + sum(before)

    def _end(self, index: int) -> int:
        return self._start(index) + self._sizes[index] + self._growth.get(index, 0)


def yaml_sites(path: str, data: bytes) -> FileSites:
    """Return every scalar of a YAML file, under its section comment, else its parent key."""
    document = read_yaml_document(data)
    sites: list[FileSite] = []
    for scalar, remark in zip(document.scalars, _yaml_remarks(document), strict=True):
        name = key_path_text(scalar.path)
        site = FileSite(
            id=f"{path}#{name}",
            kind=SiteKind.YAML,
            name=name,
            place=Place(path, scalar.line, scalar.column),
            span=scalar.span,
            text=scalar.text,
            group=remark.group or key_path_text(scalar.path[:-1]),
            annotation=_yaml_annotation(remark.comments, scalar.text, scalar.tag),
            path=scalar.path,
            remarks=remark.comments,
            tag=scalar.tag,
        )
        sites.append(site)
    return FileSites(data, tuple(sites), document.aliases)


def _yaml_annotation(comments: tuple[str, ...], text: str, tag: str) -> Annotation:
    annotation = read_annotation(comments, text)
    if not annotation.unit and tag in _TAG_UNITS:
        return replace(annotation, unit=_TAG_UNITS[tag])
    return annotation


def _yaml_remarks(document: YamlDocument) -> list[Remark]:
    """Return one remark per scalar; a key that opens a nested level ends the group above it."""
    marked = [(Entry(line, line, is_value=False), -1) for line in document.headings]
    marked += [
        (Entry(one.line, one.line, is_grouped=len(one.path) > 1), index)
        for index, one in enumerate(document.scalars)
    ]
    marked.sort(key=lambda pair: (pair[0].first_line, pair[1]))
    remarks = attach_comments([entry for entry, _ in marked], document.comments)
    found = {index: remark for (_, index), remark in zip(marked, remarks, strict=True)}
    return [found[index] for index in range(len(document.scalars))]


def xml_sites(
    tree: SourceTree, before: FileSites | None = None, known: Set[str] = frozenset()
) -> FileSites:
    """Return every arg, property, macro default and plain URDF number of an XML file.

    What was one of them in the sites before, or is known by its id, stays one, whatever is
    written there now.
    """
    known = {one.id for one in before.sites} if before else known
    remarks, shown = _xml_remarks(tree), _shown_parts(tree)
    sites: list[FileSite] = []
    for element in tree.elements:
        if element.tag in _TEXTS:
            sites += _named_texts(element, remarks.get(element.ordinal, Remark()))
        elif element.tag == "xacro:macro":
            sites += _macro_defaults(element)
        elif element.tag in NUMBERED_TAGS:
            sites += _literals(element, known, shown)
    return FileSites(tree.data, tuple(sites))


def _named_texts(element: SourceElement, remark: Remark) -> Iterator[FileSite]:
    kind, attributes = _TEXTS[element.tag]
    present = [name for name in attributes if name in element.attributes]
    if not present:
        return
    spans = attribute_spans(element.tree.data, element.offset)
    for attribute in present:
        text = element.attributes[attribute]
        yield FileSite(
            id=f"{element.tree.path}#{element.ordinal}@{attribute}",
            kind=kind,
            name=element.attributes.get("name", ""),
            place=element.place,
            span=spans[attribute],
            text=text,
            group=remark.group,
            annotation=read_annotation(remark.comments, text),
            remarks=remark.comments,
            ordinal=element.ordinal,
            attribute=attribute,
        )


def _macro_defaults(element: SourceElement) -> Iterator[FileSite]:
    if "params" not in element.attributes:
        return
    tree = element.tree
    params = attribute_spans(tree.data, element.offset)["params"]
    for default in param_defaults(tree.data, params, tree.encoding):
        yield FileSite(
            id=f"{tree.path}#{element.ordinal}@params:{default.name}",
            kind=SiteKind.PARAM_DEFAULT,
            name=default.name,
            place=element.place,
            span=default.span,
            text=default.text,
            group=element.attributes.get("name", ""),
            ordinal=element.ordinal,
            attribute="params",
        )


def _literals(
    element: SourceElement, known: Set[str], shown: dict[SourceElement, str]
) -> Iterator[FileSite]:
    """Yield the attributes of a URDF element that are plain numbers, or were."""
    start = f"{element.tree.path}#{element.ordinal}@"
    wanted = [
        name
        for name, text in element.attributes.items()
        if quantity_of_attribute(element.tag, name) is not None
        and (_is_numbers(text) or start + name in known)
    ]
    line = _ancestry(element) if wanted else ()
    if not line:
        return
    spans = attribute_spans(element.tree.data, element.offset)
    path = "/".join(_path_part(one) for one in line)
    for attribute in wanted:
        yield FileSite(
            id=start + attribute,
            kind=SiteKind.LITERAL,
            name=f"{'/'.join(shown.get(one, one.tag) for one in line)} @{attribute}",
            place=element.place,
            span=spans[attribute],
            text=element.attributes[attribute],
            group=line[0].attributes.get("name", "") or line[0].tag.removeprefix("xacro:"),
            ordinal=element.ordinal,
            attribute=attribute,
            element_path=path,
        )


def _is_numbers(text: str) -> bool:
    parts = text.split()
    if not 1 <= len(parts) <= _VECTOR_LENGTH:
        return False
    return all(parse_number(part) is not None for part in parts)


def _ancestry(element: SourceElement) -> tuple[SourceElement, ...]:
    """Return the elements from the link, joint, material or xacro element down to one of URDF.

    Nothing below a foreign element (gazebo, a sensor): the meaning of its numbers is not known.
    """
    line = [element]
    above = element.parent
    while above is not None:
        if above.tag not in _AROUND and above.xacro_name is None:
            return ()
        is_open = line[0].tag not in _NAMED and line[0].xacro_name is None
        if is_open and above.tag != "robot" and above.tag not in _CONDITIONS:
            line.insert(0, above)
        above = above.parent
    return tuple(line)


def _path_part(element: SourceElement) -> str:
    slides = element.tag == "joint" and element.attributes.get("type") == "prismatic"
    return "joint:prismatic" if slides else element.tag


def _shown_parts(tree: SourceTree) -> dict[SourceElement, str]:
    """Return the tag of each element in a link, numbered: `visual[2]` of several."""
    likes: dict[tuple[SourceElement, str], list[SourceElement]] = {}
    for element in tree.elements:
        if element.parent is not None and element.tag in _AROUND - _NAMED:
            likes.setdefault((element.parent, element.tag), []).append(element)
    return {
        element: f"{element.tag}[{number}]"
        for like in likes.values()
        if len(like) > 1
        for number, element in enumerate(like, 1)
    }


def _xml_remarks(tree: SourceTree) -> dict[int, Remark]:
    """Return the comments about each arg and property, by ordinal."""
    parents = {
        element.parent.ordinal: element.parent
        for element in tree.elements
        if element.tag in _TEXTS and element.parent is not None
    }
    remarks: dict[int, Remark] = {}
    for parent in parents.values():
        children = list(parent.elements())
        entries = [_entry(child) for child in children]
        found = attach_comments(entries, _comments(parent))
        remarks.update((one.ordinal, remark) for one, remark in zip(children, found, strict=True))
    return remarks


def _entry(element: SourceElement) -> Entry:
    is_value = element.tag in _TEXTS
    tag = element.tree.data[element.offset : element.inside] if is_value else b""
    return Entry(element.line, element.line + len(_LINE_END.findall(tag)), is_value=is_value)


def _comments(parent: SourceElement) -> list[Comment]:
    """The comments among an element's children; own line: no element stands before it there."""
    comments: list[Comment] = []
    own_line = False
    for child in parent.children:
        if isinstance(child, SourceText):
            own_line = "\n" in child.text or own_line
        elif isinstance(child, SourceComment):
            last = child.line + child.text.count("\n")
            comments.append(Comment(child.text, child.line, last, own_line=own_line))
        else:
            own_line = False
    return comments
