"""The texts of a description as an editor shows them, beside the last run that was watched."""

from __future__ import annotations

import codecs
import re
from bisect import bisect_right
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.source_store import SourceStore
from studio.description.faults import Fault
from studio.description.language.definitions import Definitions, parameter_bytes
from studio.description.language.questions import TextPlace
from studio.description.language.watched_run import Trace, WatchedRun
from studio.description.syntax.attribute_spans import attribute_spans, text_encoding
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.runs import GoodRun
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.description.values import ReadPolicy, Site

_LINE_BREAK: Final = re.compile(rb"\r\n|\r|\n")
_REST_S: Final = 1.0
"""Between two watched runs while a user types."""


class TextPlaces:
    """Places of one state of a file; `data` are its bytes."""

    def __init__(self, file: str, data: bytes) -> None:
        self.file, self.data = file, data
        self._encoding = text_encoding(data)
        self._bom_bytes = len(codecs.BOM_UTF8) if data.startswith(codecs.BOM_UTF8) else 0

    def place(self, start: int, end: int | None = None) -> TextPlace:
        """Return the place of the bytes [start, end); outside the file the nearest end of it."""
        start = max(self._bom_bytes, min(start, len(self.data)))
        line = bisect_right(self._line_starts, start) - 1
        first = self._line_starts[line]
        column = self._units(self.data[first:start]) + 1
        length = self._units(self.data[start : max(start, end)]) if end is not None else 0
        return TextPlace(self.file, line + 1, column, length)

    def line(self, number: int) -> str:
        """Return the line of text of a number from 1, without the blanks around it."""
        starts = self._line_starts
        first = starts[min(number, len(starts)) - 1]
        end = starts[number] if number < len(starts) else len(self.data)
        return self.data[first:end].decode(self._encoding, "replace").strip()

    @cached_property
    def _line_starts(self) -> list[int]:
        breaks = (found.end() for found in _LINE_BREAK.finditer(self.data))
        return [self._bom_bytes, *breaks]

    def _units(self, data: bytes) -> int:
        """Length in UTF-16 code units."""
        if data.isascii():
            return len(data)
        return len(data.decode(self._encoding, "replace").encode("utf-16-le")) // 2


class Drift:
    """Maps bytes of an old text to a new one, when one stretch of it was changed."""

    def __init__(self, old: bytes, new: bytes) -> None:
        self._old, self._new = len(old), len(new)
        self._is_same = old == new
        # The end first: what is inserted before a tag begins with `<` like the tag itself.
        self._behind = 0 if self._is_same else _common(old[::-1], new[::-1])
        left = min(len(old), len(new)) - self._behind
        self._before = 0 if self._is_same else _common(old[:left], new[:left])

    def to_new(self, byte: int) -> int:
        """Return the place in the new text; what is gone is where the change begins."""
        return self._moved(byte, self._old, self._new)

    def to_old(self, byte: int) -> int:
        """Return the place in the old text; what is new is where the change begins."""
        return self._moved(byte, self._new, self._old)

    def _moved(self, byte: int, length: int, to_length: int) -> int:
        if self._is_same or byte < self._before:
            return byte
        if byte >= length - self._behind:
            return byte + to_length - length
        return self._before


def _common(left: bytes, right: bytes) -> int:
    """Length of what two texts begin with alike."""
    low, high = 0, min(len(left), len(right))
    while low < high:
        middle = (low + high + 1) // 2
        if left[low:middle] == right[low:middle]:
            low = middle
        else:
            high = middle - 1
    return low


class _Mirror(SourceStore):
    """A store that reads another one's texts and leaves no trace in it; trees are its own."""

    def __init__(self, store: SourceStore) -> None:
        super().__init__(store._roots, {})
        self._store = store
        self._instead: Mapping[str, bytes] = {}

    @property
    def instead(self) -> Mapping[str, bytes]:
        """The texts in use in the place of the other store's."""
        return self._instead

    def use(self, instead: Mapping[str, bytes]) -> None:
        """Take these texts, by resolved path, in the place of the other store's."""
        self._instead = instead

    def resolve(self, path: str) -> str:
        return self._store.resolve(path)

    def read(self, path: str) -> tuple[str, bytes]:
        real = self._store.resolve(path)
        self.asked[real] = None
        data = self._instead.get(real)
        if data is None:
            data = self._read_quietly(real)
        known = self._trees.get(real)
        return real, known.data if known is not None and known.data == data else data

    def _read_quietly(self, real: str) -> bytes:
        asked, self._store.asked = self._store.asked, {}
        try:
            return self._store.read(real)[1]
        finally:
            self._store.asked = asked


class Reading:
    """What is known of the texts at the moment of a question."""

    def __init__(self, store: SourceStore, policy: ReadPolicy, entry: str) -> None:
        self.policy = policy
        self.trace: Trace | None = None
        """The last run that was watched and worked."""
        self.sites: Mapping[str, Site] = {}
        self.is_current = False
        """Whether the texts are still those of the trace."""
        self._entry = entry
        self._mirror = _Mirror(store)
        self._arguments: Mapping[str, str] = {}
        self._is_of_arguments = False
        """Whether the trace was run with these arguments."""
        self._failed: dict[str, bytes] | None = None
        self._followed: GoodRun | None = None
        self._watched_s = 0.0
        self._by_offset: dict[str, tuple[SourceTree, dict[int, SourceElement]]] = {}
        self._drifts: dict[str, tuple[bytes, bytes, Drift]] = {}
        self._places: dict[str, TextPlaces] = {}
        self._definitions: Definitions | None = None

    def begin(
        self, texts: Mapping[str, bytes], arguments: Mapping[str, str], sites: Mapping[str, Site]
    ) -> None:
        """Take the texts of a question; of files that it does not name, the store's."""
        self._mirror.use(texts)
        self.sites = sites
        if dict(arguments) != self._arguments:
            self._arguments, self._failed, self._is_of_arguments = dict(arguments), None, False
        is_watched = self.trace is not None and self._is_of_arguments
        self.is_current = is_watched and self._is_as_read(self._bytes_of(self.trace))

    def watch(self, good: GoodRun | None) -> None:
        """Run the texts, unless that was done; what breaks in between changes nothing.

        Args:
            good: The last good run, whose texts count while these do not run.
        """
        if self.is_current or (self._failed is not None and self._is_as_read(self._failed)):
            return
        if self._run():
            self.is_current = True
            return
        self._failed = self._what_was_asked()
        if self.trace is None and good is not None:
            self._run_good(good)

    def follow(self, good: GoodRun | None) -> None:
        """Take what the last good run has brought since, but not at every letter.

        For questions in the midst of typing: the text is broken then most of the time.
        """
        if self.trace is None:
            self.watch(good)
        rested = perf_counter() - self._watched_s > _REST_S
        if good is None or good is self._followed or self.is_current or not rested:
            return
        failed = self._failed
        self._run_good(good)
        self._failed = failed

    def tried(
        self, texts: Mapping[str, bytes], arguments: Mapping[str, str] | None = None
    ) -> Trace | None:
        """Return a run with other texts or arguments, as a trial. None: they do not run."""
        instead = self._mirror.instead
        self._mirror.use({**instead, **texts})
        given = self._arguments if arguments is None else arguments
        try:
            return WatchedRun(self._mirror, self.policy, given).trace(self._entry)
        except Fault:
            return None
        finally:
            self._mirror.use(instead)

    @property
    def arguments(self) -> Mapping[str, str]:
        """The arguments of the question."""
        return self._arguments

    def _run_good(self, good: GoodRun) -> None:
        """Run the texts of a good run."""
        instead = self._mirror.instead
        self._followed = good
        try:
            texts = {path: good.store.read(path)[1] for path in good.record.files}
        except Fault:  # a file that is gone from the disk since
            return
        self._mirror.use(texts)
        self._run()
        self._mirror.use(instead)

    @property
    def definitions(self) -> Definitions | None:
        """The definitions in the files of the watched run."""
        if self.trace is None:
            return None
        if self._definitions is None or self._definitions.trace is not self.trace:
            self._definitions = Definitions(self.trace)
        return self._definitions

    def _run(self) -> bool:
        try:
            trace = WatchedRun(self._mirror, self.policy, self._arguments).trace(self._entry)
        except Fault:
            return False
        self.trace, self._failed, self._is_of_arguments = trace, None, True
        self._watched_s = perf_counter()
        return True

    def _bytes_of(self, trace: Trace | None) -> dict[str, bytes]:
        if trace is None:
            return {}
        texts = {path: tree.data for path, tree in trace.trees.items()}
        return texts | {path: one.data for path, one in trace.yaml.items()}

    def _what_was_asked(self) -> dict[str, bytes]:
        read = ((path, self.text(path)) for path in tuple(self._mirror.asked))
        return {path: data for path, data in read if data is not None}

    def _is_as_read(self, texts: Mapping[str, bytes]) -> bool:
        return all(self.text(path) == data for path, data in texts.items())

    def text(self, path: str) -> bytes | None:
        """Return the bytes of a file as they are now; None when it cannot be read."""
        try:
            return self._mirror.read(path)[1]
        except Fault:
            return None

    def resolve(self, path: str) -> str | None:
        """Return the name under which a file is known; None when it may not be read."""
        try:
            return self._mirror.resolve(path)
        except Fault:
            return None

    def element_at(self, file: str, byte: int, tag: str) -> SourceElement | None:
        """Return the element of the watched run whose `<` is there in the text of now."""
        tree = self.trace.trees.get(file) if self.trace else None
        if tree is None:
            return None
        known = self._by_offset.get(file)
        if known is None or known[0] is not tree:
            known = self._by_offset[file] = tree, {one.offset: one for one in tree.elements}
        found = known[1].get(self._drift(file, tree.data).to_old(byte))
        return found if found is not None and found.tag == tag else None

    def place(self, file: str, start: int, end: int | None = None) -> TextPlace:
        """Return where bytes of the watched run's text are in the present text."""
        trace = self.trace
        tree, yaml = (trace.trees.get(file), trace.yaml.get(file)) if trace else (None, None)
        old = tree.data if tree else yaml.data if yaml else None
        if old is None:
            return self.places(file).place(start, end)
        drift = self._drift(file, old)
        moved = drift.to_new(start)
        return self.places(file).place(moved, None if end is None else moved + end - start)

    def element_place(self, element: SourceElement, attribute: str = "name") -> TextPlace:
        """Return the place of an attribute's text; without one, of its element's begin."""
        tree = element.tree
        try:
            span = attribute_spans(tree.data, element.offset).get(attribute)
        except EditError:
            span = None
        if span is None:
            return self.place(tree.path, element.offset)
        return self.place(tree.path, span.start, span.end)

    def parameter_place(self, macro: SourceElement, name: str) -> TextPlace:
        """Return where a macro names its parameter."""
        named = parameter_bytes(macro, name)
        return self.place(macro.tree.path, *named) if named else self.element_place(macro)

    def places(self, file: str) -> TextPlaces:
        """Return places in the text of now."""
        data = self.text(file) or b""
        known = self._places.get(file)
        if known is None or known.data is not data:
            known = self._places[file] = TextPlaces(file, data)
        return known

    def _drift(self, file: str, old: bytes) -> Drift:
        new = self.text(file) or b""
        known = self._drifts.get(file)
        if known is None or known[0] is not old or known[1] is not new:
            known = self._drifts[file] = old, new, Drift(old, new)
        return known[2]
