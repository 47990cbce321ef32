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
    from studio.description.sites.editable_texts import Draft, FileDrafts
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.description.values import Edit, Site
    from studio.problems import Problem

_LINE_END: Final = re.compile(rb"\r\n?|\n")
_ONE_LINE: Final = re.compile(rb"[\x20-\x7e]*")
_PLAIN: Final = re.compile(rb"[\x20\x21\x23\x25\x28-\x3b\x3d-\x7e]*")
"""Printable ASCII without `"`, `'`, `$`, `&` and `<`."""
_WORD: Final = re.compile(rb"[\w.+-]*[a-zA-Z0-9][\w.+-]*", re.ASCII)


class LiveDrafts:
    """Follows the edits of one file, each inside one draft and on its line."""

    def __init__(self, file: FileDrafts) -> None:
        self._drafts = list(file.drafts)
        self._starts = [one.span.start for one in file.drafts]
        self._ends = [one.span.end for one in file.drafts]
        self.index_of = {draft.id: index for index, draft in enumerate(file.drafts)}
        self.has_aliases = bool(file.aliases)

    def find(self, edit: Edit) -> int | None:
        """The draft that an edit lies in."""
        for index, (start, end) in enumerate(zip(self._starts, self._ends, strict=True)):
            if start <= edit.start and edit.end <= end:
                return index
        return None

    def draft(self, index: int) -> Draft:
        """A draft as it stands now."""
        draft = self._drafts[index]
        start, end = self._starts[index], self._ends[index]
        if (draft.span.start, draft.span.end) != (start, end):
            draft = self._drafts[index] = replace(draft, span=Span(start, end, draft.span.syntax))
        return draft

    def written(self, site: str) -> Draft:
        """A draft as it is now by its id, but for its span."""
        return self._drafts[self.index_of[site]]

    def by_id(self, site: str) -> Draft:
        """A draft as it stands now, by its id."""
        return self.draft(self.index_of[site])

    def take(self, index: int, edit: Edit, text: str) -> None:
        """Write another text at a draft; those behind it move."""
        growth = len(edit.new) - (edit.end - edit.start)
        start, end = self._starts[index], self._ends[index]
        self._drafts[index] = self._drafts[index].rewritten(text)
        if growth:
            self._starts = [at + growth if at >= end else at for at in self._starts]
            self._ends = [at + growth if at > end else at for at in self._ends]
            self._starts[index], self._ends[index] = start, end + growth

    def move_yaml(self, index: int, growth: int) -> list[str]:
        """Shift the columns of what stands behind a draft on its line; the ids of what moved."""
        at, line = self._starts[index], self._drafts[index].place.line
        behind = (n for n, one in enumerate(self._drafts) if one.place.line == line)
        moved = [n for n in behind if self._starts[n] > at]
        for number in moved:
            place = self._drafts[number].place
            self._place(number, Place(place.file, line, place.column + growth))
        return [self._drafts[number].id for number in moved]

    def move_elements(self, places: Mapping[int, Place]) -> list[str]:
        """Put drafts where their elements are now, by ordinal; the ids of what moved."""
        moved = [number for number, one in enumerate(self._drafts) if one.ordinal in places]
        for number in moved:
            self._place(number, places[self._drafts[number].ordinal])
        return [self._drafts[number].id for number in moved]

    def _place(self, index: int, place: Place) -> None:
        self._drafts[index] = replace(self._drafts[index], place=place)


class TextEdits:
    """The files of one good run and the edits since."""

    def __init__(self, store: SourceStore, files: Mapping[str, FileDrafts]) -> None:
        self._store, self._files = store, files
        self._live: dict[str, LiveDrafts] = {}
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

    def has(self, path: str, site: str) -> bool:
        """Whether there is such a site."""
        return path in self._files and site in self.live(path).index_of

    @property
    def edited(self) -> frozenset[str]:
        """Files that were edited."""
        return frozenset(self._live)

    def live(self, path: str) -> LiveDrafts:
        """The drafts of a file as they are now."""
        live = self._live.get(path)
        if live is None:
            live = self._live[path] = LiveDrafts(self._files[path])
        return live

    def now(self, path: str, site: str) -> Draft:
        """A draft as it is now."""
        return self.live(path).by_id(site)

    def written(self, path: str, site: str) -> Draft:
        """A draft as it is now, but for its span."""
        return self.live(path).written(site)

    def moved(self, sites: Mapping[str, Site]) -> Iterator[tuple[str, Site]]:
        """Sites that moved with edits before them, where they are now."""
        for live in self._live.values():
            for name in live.index_of:
                site, span = sites[name], live.by_id(name).span
                if span != site.span:
                    yield name, replace(site, span=span)

    def take(self, edit: Edit, warnings: Sequence[Problem]) -> tuple[str, Draft, list[str]]:
        """Carry out one edit in the bytes and in what is parsed of them.

        Returns:
            The file, the draft as it was before, and the ids of the drafts that moved on its line.

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
        draft = live.draft(index)
        tree, values = self._store.held(path)
        if (tree is None) == (values is None):
            raise PatchRefused("the file is parsed anew")
        self._before.setdefault(path, self._store.read(path)[1])
        if tree is not None:
            return path, draft, _XmlEdit(tree, live, index, edit).carry_out(self._store, warnings)
        return path, draft, self._edit_yaml(path, live, index, edit)

    def _edit_yaml(self, path: str, live: LiveDrafts, index: int, edit: Edit) -> list[str]:
        if live.has_aliases:
            raise PatchRefused("a value may stand in several places")
        span, data = live.draft(index).span, self._store.read(path)[1]
        old, new = data[span.start : span.end], _spliced(data, span.start, span.end, edit)
        if not _WORD.fullmatch(old) or not _WORD.fullmatch(new):
            raise PatchRefused("it is no single word")
        self._store.keep(path, data[: edit.start] + edit.new + data[edit.end :])
        live.take(index, edit, new.decode())
        return live.move_yaml(index, len(new) - len(old)) if len(new) != len(old) else []


class _XmlEdit:
    """One edit of one attribute."""

    def __init__(self, tree: SourceTree, live: LiveDrafts, index: int, edit: Edit) -> None:
        self._tree, self._live, self._index, self._edit = tree, live, index, edit
        self._draft = live.draft(index)
        span = self._draft.span
        self._old = tree.data[span.start : span.end]
        self._new = _spliced(tree.data, span.start, span.end, edit)

    def carry_out(self, store: SourceStore, warnings: Sequence[Problem]) -> list[str]:
        """Do it; the ids of the drafts that moved on its line."""
        if not _ONE_LINE.fullmatch(self._old) or not _PLAIN.fullmatch(self._new):
            raise PatchRefused("it is not plain text on one line")
        tree, edit, draft = self._tree, self._edit, self._draft
        element = tree.elements[draft.ordinal]
        line = element.line + len(_LINE_END.findall(tree.data[element.offset : edit.start]))
        data = tree.data[: edit.start] + edit.new + tree.data[edit.end :]
        written = self._new.decode("ascii")
        if draft.kind is SiteKind.PARAM_DEFAULT:
            written = self._parameters(element, data)
        element.attributes = {**element.attributes, draft.attribute: written}
        element.plan = None
        store.keep(tree.path, data)
        self._live.take(self._index, edit, self._text())
        places = self._shift(line)
        if places:
            _check_warnings(warnings, tree.path, line)
        return self._live.move_elements(places) if places else []

    def _text(self) -> str:
        return self._new.decode("ascii")

    def _parameters(self, element: SourceElement, data: bytes) -> str:
        """What `params` says then; nothing but the one default may be read otherwise.

        Raises:
            PatchRefused: Something may.
        """
        name, old, new = self._draft.name, self._old.decode("ascii"), self._new.decode("ascii")
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
        around: SourceElement | None = tree.elements[self._draft.ordinal]
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
