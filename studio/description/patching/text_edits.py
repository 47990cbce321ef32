"""Edits of the texts behind sites, made in the parsed files as well as in their bytes.

Only where nothing else can follow: one plain text gives way to another on the same line, so every
element stays what it is and where it is, except for the bytes and columns behind the edit.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.description.patching.propagation import PatchRefused
from studio.description.syntax.attribute_spans import attribute_spans, attribute_text
from studio.description.syntax.params import read_parameters
from studio.description.values import SiteKind, Span
from studio.errors import EditError
from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from studio.description.evaluator.source_store import SourceStore
    from studio.description.sites.file_sites import FileSite, FileSites
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.description.values import Edit, Site
    from studio.problems import Problem

_LINE_END: Final = re.compile(rb"\r\n?|\n")
_ONE_LINE: Final = re.compile(rb"[\x20-\x7e]*")
_PLAIN: Final = re.compile(rb"[\x20\x21\x23\x25\x28-\x3b\x3d-\x7e]*")
"""Printable ASCII without `"`, `'`, `$`, `&` and `<`."""
_WORD: Final = re.compile(rb"[\w.+-]*[a-zA-Z0-9][\w.+-]*", re.ASCII)


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
        """The site that an edit lies in."""
        at = bisect_right(self._in_order, edit.start, key=self._start)
        if not at:
            return None
        index = self._in_order[at - 1]
        return index if edit.end <= self._end(index) else None

    def site(self, index: int) -> FileSite:
        """A site as it stands now."""
        site, start, end = self._sites[index], self._start(index), self._end(index)
        if (site.span.start, site.span.end) != (start, end):
            site = self._sites[index] = replace(site, span=Span(start, end, site.span.syntax))
        return site

    def by_id(self, site_id: str) -> FileSite:
        """A site as it stands now, by its id."""
        return self.site(self.index_of[site_id])

    def without_span(self, site_id: str) -> FileSite:
        """A site as it is now by its id; its span may be an earlier one."""
        return self._sites[self.index_of[site_id]]

    def write(self, index: int, edit: Edit, text: str) -> None:
        """Have another text stand at a site; those behind it move."""
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


class TextEdits:
    """The files of one good run and the edits since."""

    def __init__(self, store: SourceStore, files: Mapping[str, FileSites]) -> None:
        self._store, self._files = store, files
        self._live: dict[str, LiveSites] = {}
        self._before: dict[str, bytes] = {}
        """Files edited since the last good state, as they were then."""

    def begin(self) -> None:
        """What was done so far is good."""
        self._before.clear()

    def take_back(self) -> None:
        """Give the store its bytes back; what was parsed of them is parsed anew."""
        for path, data in self._before.items():
            self._store.restore(path, data)

    def distrust(self) -> None:
        """Have the values of edited YAML files read anew: they may not follow the bytes."""
        for path in self._before:
            if self._store.held(path)[1] is not None:
                self._store.restore(path, self._store.read(path)[1])

    def has(self, path: str, site_id: str) -> bool:
        """Whether there is such a site."""
        return path in self._files and site_id in self.live(path).index_of

    @property
    def edited(self) -> frozenset[str]:
        """Files that were edited."""
        return frozenset(self._live)

    def live(self, path: str) -> LiveSites:
        """The sites of a file as they are now."""
        live = self._live.get(path)
        if live is None:
            live = self._live[path] = LiveSites(self._files[path])
        return live

    def site(self, path: str, site_id: str) -> FileSite:
        """A site as it is now."""
        return self.live(path).by_id(site_id)

    def without_span(self, path: str, site_id: str) -> FileSite:
        """A site as it is now; its span may be an earlier one."""
        return self.live(path).without_span(site_id)

    def moved(self, sites: Mapping[str, Site]) -> Iterator[tuple[str, Site]]:
        """Sites that moved with edits before them, where they are now."""
        for live in self._live.values():
            for name in live.index_of:
                site, span = sites[name], live.by_id(name).span
                if span != site.span:
                    yield name, replace(site, span=span)

    def take(self, edit: Edit, warnings: Sequence[Problem]) -> tuple[str, FileSite, list[str]]:
        """Carry out one edit in the bytes and in what is parsed of them.

        Returns:
            The file, the site as it was before, and the ids of the sites that moved on its line.

        Raises:
            PatchRefused: It is no such edit; only a full run may follow now.
        """
        path = self._store.resolve(edit.file)
        if path not in self._files:
            raise PatchRefused("the run did not read the file")
        live = self.live(path)
        index = live.find(edit)
        if index is None:
            raise PatchRefused("it edits more than a value")
        site = live.site(index)
        tree, values = self._store.held(path)
        if (tree is None) == (values is None):
            raise PatchRefused("the file is parsed anew")
        self._before.setdefault(path, self._store.read(path)[1])
        if tree is not None:
            return path, site, _XmlEdit(tree, live, index, edit).carry_out(self._store, warnings)
        return path, site, self._edit_yaml(path, live, index, edit)

    def _edit_yaml(self, path: str, live: LiveSites, index: int, edit: Edit) -> list[str]:
        if live.has_aliases:
            raise PatchRefused("a value may stand in several places")
        span, data = live.site(index).span, self._store.read(path)[1]
        old, new = data[span.start : span.end], _spliced(data, span.start, span.end, edit)
        if not _WORD.fullmatch(old) or not _WORD.fullmatch(new):
            raise PatchRefused("it is no single word")
        self._store.keep(path, data[: edit.start] + edit.new + data[edit.end :])
        live.write(index, edit, new.decode())
        return live.move_behind(index, len(new) - len(old)) if len(new) != len(old) else []


class _XmlEdit:
    """One edit of one attribute."""

    def __init__(self, tree: SourceTree, live: LiveSites, index: int, edit: Edit) -> None:
        self._tree, self._live, self._index, self._edit = tree, live, index, edit
        self._site = live.site(index)
        span = self._site.span
        self._old = tree.data[span.start : span.end]
        self._new = _spliced(tree.data, span.start, span.end, edit)

    def carry_out(self, store: SourceStore, warnings: Sequence[Problem]) -> list[str]:
        """Do it; the ids of the sites that moved on its line."""
        if not _ONE_LINE.fullmatch(self._old) or not _PLAIN.fullmatch(self._new):
            raise PatchRefused("it is not plain text on one line")
        tree, edit, site = self._tree, self._edit, self._site
        element = tree.elements[site.ordinal]
        line = element.line + len(_LINE_END.findall(tree.data[element.offset : edit.start]))
        data = tree.data[: edit.start] + edit.new + tree.data[edit.end :]
        written = self._new.decode("ascii")
        if site.kind is SiteKind.PARAM_DEFAULT:
            written = self._parameters(element, data)
        element.attributes = {**element.attributes, site.attribute: written}
        element.plan = None
        store.keep(tree.path, data)
        self._live.write(self._index, edit, self._new.decode("ascii"))
        places = self._shift(line)
        if places:
            _check_warnings(warnings, tree.path, line)
        return self._live.move_elements(places) if places else []

    def _parameters(self, element: SourceElement, data: bytes) -> str:
        """What `params` says then; nothing but the one default may be read otherwise.

        Raises:
            PatchRefused: Something may.
        """
        name, old, new = self._site.name, self._old.decode("ascii"), self._new.decode("ascii")
        if not _WORD.fullmatch(self._new):
            raise PatchRefused("the default is no single word")
        try:
            span = attribute_spans(data, element.offset)["params"]
            written = attribute_text(data[span.start : span.end], element.tree.encoding)
        except (EditError, KeyError):
            raise PatchRefused("the parameters cannot be found") from None
        names, defaults = read_parameters(element.attributes["params"])
        names_then, defaults_then = read_parameters(written)
        was, is_now = defaults.pop(name, None), defaults_then.pop(name, None)
        same = names == names_then and defaults == defaults_then
        if not same or was is None or is_now is None or was.forward != is_now.forward:
            raise PatchRefused("other parameters change, too")
        if (was.text, is_now.text) != (old, new) or names.count(name) != 1:
            raise PatchRefused("the default is read otherwise")
        return written

    def _shift(self, line: int) -> dict[int, Place]:
        """Move what stands behind the edit; the places of the elements that moved on its line."""
        edit, tree = self._edit, self._tree
        growth = len(edit.new) - (edit.end - edit.start)
        if not growth:
            return {}
        moved: dict[int, Place] = {}
        behind = bisect_right(tree.elements, edit.start, key=_offset)
        for element in tree.elements[behind:]:
            element.offset += growth
            element.end_tag += growth
            if element.line == line:
                element.column += growth
                moved[element.ordinal] = element.place
        around: SourceElement | None = tree.elements[self._site.ordinal]
        while around is not None:
            around.end_tag += growth
            around = around.parent
        for comment in tree.comments:
            if comment.offset > edit.start:
                comment.offset += growth
        return moved


def _offset(element: SourceElement) -> int:
    return element.offset


def _spliced(data: bytes, start: int, end: int, edit: Edit) -> bytes:
    return data[start : edit.start] + edit.new + data[edit.end : end]


def _check_warnings(warnings: Sequence[Problem], path: str, line: int) -> None:
    """See that no warning stands where columns moved.

    Raises:
        PatchRefused: One may.
    """
    if any(one.place and (one.place.file, one.place.line) == (path, line) for one in warnings):
        raise PatchRefused("a warning moves")
