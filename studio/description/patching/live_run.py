"""The last good run, kept so that an edit changes only what depends on it.

A patch gives the result of a full run; where that is not certain it is refused, and the full run is
made. After a refusal this run cannot be used any more: the texts have changed without it.

A text is edited in the parsed files as well as in their bytes where nothing else can depend on it:
plain text replaces another on the same line, so every element stays what it is and where it is,
except for the bytes and columns behind the edit.
"""

from __future__ import annotations

import logging
import re
from bisect import bisect_right
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Final, NamedTuple

from studio.description.evaluator.graph import Argument, Cell, YamlValue
from studio.description.evaluator.texts import literal_value, pure_value
from studio.description.evaluator.yaml_values import replace_item, rewrite
from studio.description.faults import Fault
from studio.description.patching.propagation import (
    Detaching,
    PatchRefused,
    Propagation,
    Replay,
    is_same,
)
from studio.description.sites.file_sites import LiveSites
from studio.description.syntax.attribute_spans import attribute_spans, attribute_text
from studio.description.syntax.params import read_parameters
from studio.description.syntax.yaml_reading import scalar_of
from studio.description.values import SiteKind
from studio.errors import EditError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from studio.description.evaluator.evaluation import Evaluation
    from studio.description.evaluator.graph import Binding
    from studio.description.evaluator.output_tree import OutputElement, OutputIndex
    from studio.description.evaluator.runs import RunRecord
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.sites.file_sites import FileSite, FileSites
    from studio.description.sites.sites import RunReads
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.description.values import Edit, Site
    from studio.problems import Place, Problem


_LINE_END: Final = re.compile(rb"\r\n?|\n")
_ONE_LINE: Final = re.compile(rb"[\x20-\x7e]*")
_PLAIN: Final = re.compile(rb"[\x20\x21\x23\x25\x28-\x3b\x3d-\x7e]*")
"""Printable ASCII without `"`, `'`, `$`, `&` and `<`."""
_WORD: Final = re.compile(rb"[\w.+-]*[a-zA-Z0-9][\w.+-]*", re.ASCII)


class Patch(NamedTuple):
    """What changed."""

    parts: tuple[OutputElement, ...]
    """Parts, by their element, that are to be written again."""
    sites: dict[str, str]
    """Sites that may be other ones, by id, with their file."""


class _Edited(NamedTuple):
    path: str
    before: FileSite


class LiveRun:
    """One good run of our own evaluator and the edits since."""

    def __init__(
        self,
        evaluation: Evaluation,
        record: RunRecord,
        index: OutputIndex,
        reads: RunReads,
        files: Mapping[str, FileSites],
    ) -> None:
        self.record, self.index, self.reads, self.files = record, index, reads, files
        self.evaluation, self.replay = evaluation, Replay(evaluation.texts)
        self.texts = TextEdits(evaluation.store, files)
        self.has_edited = False
        """Whether the store holds the edits that were asked for last."""

    @property
    def can_patch(self) -> bool:
        """Whether its expressions come to the same when they are evaluated again."""
        return self.evaluation.texts.is_pure

    def edit(self, edits: Iterable[Edit]) -> Patch | None:
        """Make edits in the texts and in the run; None when only a full run can evaluate them.

        `has_edited` is then whether the store holds all of them, or none.
        """
        self.has_edited = False
        self.texts.begin()
        work = _Work(self)
        edited: dict[str, _Edited] = {}
        try:
            for edit in edits:
                path, site, moved = self.texts.take(edit, self.record.warnings)
                edited.setdefault(site.id, _Edited(path, site))
                work.sites.update(dict.fromkeys(moved, path))
        except Exception as reason:  # noqa: BLE001 - whatever it is, a full run does it
            _log_refusal(reason)
            self.texts.take_back()
            return None
        self.has_edited = True
        try:
            for one in edited.values():
                work.take(one.path, one.before, self.texts.live(one.path).by_id(one.before.id))
            return work.finish(self.texts)
        except Exception as reason:  # noqa: BLE001 - as above
            _log_refusal(reason)
            self.texts.distrust()
            return None

    def set_arguments(self, old: Mapping[str, str], new: Mapping[str, str]) -> Patch | None:
        """Give arguments other values; None when only a full run can evaluate them."""
        if old.keys() != new.keys():
            return None
        work = _Work(self)
        try:
            for name, value in new.items():
                if value != old[name]:
                    work.set_argument(self.evaluation.texts.arguments[name], value)
            return work.finish(self.texts)
        except Exception as reason:  # noqa: BLE001 - as above
            _log_refusal(reason)
            return None

    def expect_edits_like(self, before: LiveRun) -> None:
        """Prepare for edits of the files that were edited before, while nobody waits."""
        for path in before.texts.edited & self.files.keys():
            self.texts.live(path)
        if "containers" in vars(before):
            self.note_containers(self.containers)

    @cached_property
    def containers(self) -> dict[Cell | Argument, None]:
        """Whatever is bound to a list or mapping, of a YAML file perhaps."""
        holders = (one for binding in self.record.bindings for one in binding.holders)
        return {one: None for one in holders if isinstance(one.value, dict | list | tuple)}

    def note_containers(self, changed: Iterable[Cell | Argument]) -> None:
        """Handle what has another value now."""
        if "containers" in vars(self):
            found = (one for one in changed if isinstance(one.value, dict | list | tuple))
            self.containers.update(dict.fromkeys(found))


class _Work:
    """One request carried through the graph."""

    def __init__(self, run: LiveRun) -> None:
        self._run, self._texts = run, run.evaluation.texts
        self._propagation = Propagation(run.replay, run.index)
        self._detaching = Detaching(self._propagation, self._texts.asked_at)
        self.sites: dict[str, str] = {}
        """Files by the ids of sites that may be other ones."""
        self._texts.budget.restart()

    def take(self, path: str, before: FileSite, now: FileSite) -> None:
        """A site has another text."""
        self.sites[now.id] = path
        if now.text == before.text:
            return
        match now.kind:
            case SiteKind.LITERAL:
                self._set_literal(path, before, now)
            case SiteKind.YAML:
                self._set_scalar(path, before, now)
            case _:
                for binding in self._run.reads.bindings(path, now):
                    self._bind(binding, now.text)

    def set_argument(self, argument: Argument, value: str) -> None:
        """An argument is given another value."""
        if "$" in value or "$" in argument.value:
            raise PatchRefused("the argument is a text to evaluate")
        self._propagation.put(argument, value)

    def finish(self, texts: TextEdits) -> Patch:
        """Evaluate what depends on all that, and return what changed."""
        self._propagation.run()
        for holder in self._propagation.changed:
            self._touch_bindings(holder)
        for read in self._detaching.unlinked:
            if isinstance(read, YamlValue):
                self._run.reads.readers_changed(read)
                self._touch_site(read)
            elif isinstance(read, Cell | Argument):
                if read.binding is not None:
                    self._run.reads.readers_changed(read.binding)
                self._touch_bindings(read)
        self._run.note_containers(self._propagation.changed)
        known = {one: path for one, path in self.sites.items() if texts.has(path, one)}
        return Patch(tuple(self._propagation.parts), known)

    def _touch_bindings(self, holder: Cell | Argument) -> None:
        bound = holder.declarations if isinstance(holder, Argument) else (holder.binding,)
        for binding in bound:
            if binding is not None and binding.kind is not None:
                self._touch_site(binding)

    def _touch_site(self, one: Binding | YamlValue) -> None:
        path, site = self._run.reads.site_of(one, self._run.files)
        if site is not None:
            self.sites[site] = path

    def _bind(self, binding: Binding, text: str) -> None:
        binding.text = text
        for holder in binding.holders:
            if isinstance(holder, Argument):
                if not binding.overridden:
                    self._detach(holder)
                    self._propagation.put(holder, text)
            elif holder.record is None or not holder.record.forwards:
                self._rebind(holder, text)

    def _rebind(self, cell: Cell, text: str) -> None:
        if cell.pending is not None:
            cell.pending = None
            self._propagation.changed[cell] = None
        self._detach(cell)
        # What waits for its first reader is typed once more when it is read.
        self._propagation.put(cell, literal_value(text) if cell.is_lazy else text)

    def _detach(self, holder: Cell | Argument) -> None:
        record, holder.record = holder.record, None
        if record is not None:
            self._propagation.changed[holder] = None
            self._detaching.detach(record)

    def _set_literal(self, path: str, before: FileSite, now: FileSite) -> None:
        if "$" in before.text:
            raise PatchRefused("the attribute was evaluated")
        element = self._run.record.trees[path].elements[now.ordinal]
        name = now.attribute
        for made in self._run.index.came_out.get(element, ()):
            if name in made.makers:
                continue
            if made.attributes.get(name) != before.text:
                raise PatchRefused("the attribute came out otherwise")
            self._propagation.write(made, name, now.text)

    def _set_scalar(self, path: str, before: FileSite, now: FileSite) -> None:
        reads = self._run.record.yaml[path]
        container = self._container(path, now)
        key = now.path[-1]
        old, new = _scalar(before), _scalar(now)
        if not is_same(_item(container, key), old):
            raise PatchRefused("the value was read otherwise")
        if any(now.path[:size] in reads.whole for size in range(len(now.path) + 1)):
            raise PatchRefused("it was read with all that stands around it")
        replace_item(container, key, new)
        reads.data = self._run.evaluation.store.read(path)[1]
        for holder in self._run.containers:
            rewrite(holder.value, reads, now.path, new)
        scalar = reads.values.get(now.path)
        if scalar is not None:
            self._propagation.touch(scalar)

    def _container(self, path: str, site: FileSite) -> object:
        """Return the mapping or list of plain values that a scalar stands in."""
        container = self._run.evaluation.store.held(path)[1]
        if not site.path or path not in self._run.record.yaml:
            raise PatchRefused("the file is one value")
        for key in site.path[:-1]:
            container = _item(container, key)
        return container


class TextEdits:
    """The files of one good run and the edits since."""

    def __init__(self, store: SourceStore, files: Mapping[str, FileSites]) -> None:
        self._store, self._files = store, files
        self._live: dict[str, LiveSites] = {}
        self._before: dict[str, bytes] = {}
        """Files edited since the last good state, as they were then."""

    def begin(self) -> None:
        """Accept what was done so far."""
        self._before.clear()

    def take_back(self) -> None:
        """Restore the bytes in the store; what was parsed of them is parsed again."""
        for path, data in self._before.items():
            self._store.restore(path, data)

    def distrust(self) -> None:
        """Forget the values of edited YAML files: they may not match the bytes."""
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
        """Return the sites of a file as they are now."""
        live = self._live.get(path)
        if live is None:
            live = self._live[path] = LiveSites(self._files[path])
        return live

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
        line = element.place.line + len(_LINE_END.findall(tree.data[element.offset : edit.start]))
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
        """Return the new `params`; only the one default may be read differently.

        Raises:
            PatchRefused: Something else may.
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
            place = element.place
            if place.line == line:
                element.place = replace(place, column=place.column + growth)
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
    """Check that there is no warning where columns moved.

    Raises:
        PatchRefused: One may.
    """
    if any(one.place and (one.place.file, one.place.line) == (path, line) for one in warnings):
        raise PatchRefused("a warning moves")


_log = logging.getLogger(__name__)


def _log_refusal(reason: Exception) -> None:
    """Log what is no refusal: a mistake of ours."""
    if not isinstance(reason, PatchRefused | Fault):
        _log.error("A patch failed; the full run is made instead.", exc_info=reason)


def _item(container: object, key: str | int) -> object:
    try:
        return container[key]  # pyright: ignore
    except (LookupError, TypeError):
        raise PatchRefused("the value was read otherwise") from None


def _scalar(site: FileSite) -> object:
    try:
        return scalar_of(site.text, site.tag, pure_value)
    except (Fault, ArithmeticError, LookupError, TypeError, ValueError):
        raise PatchRefused("it is no value by itself") from None
