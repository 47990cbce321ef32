"""The last good run, kept so that an edit changes only what depends on it.

What a patch gives is what a full run would have given; where that is not certain it is refused,
and the full run is made. After a refusal this run is spent: the texts have gone on without it.
"""

from __future__ import annotations

import logging
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from studio.description.evaluator.graph import Argument, Cell, YamlValue
from studio.description.evaluator.texts import pure_value
from studio.description.evaluator.yaml_values import replace_item, rewrite
from studio.description.faults import Fault
from studio.description.patching.propagation import (
    Detaching,
    PatchRefused,
    Propagation,
    Replay,
    is_same,
)
from studio.description.patching.text_edits import TextEdits
from studio.description.syntax.templates import literal_value
from studio.description.syntax.yaml_reading import scalar_of
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.description.evaluator.evaluation import Evaluation
    from studio.description.evaluator.graph import Binding
    from studio.description.evaluator.output_tree import OutputElement, OutputIndex
    from studio.description.evaluator.runs import RunRecord
    from studio.description.sites.file_sites import FileSite, FileSites
    from studio.description.sites.sites import RunReads
    from studio.description.values import Edit

_log = logging.getLogger(__name__)


class Patch(NamedTuple):
    """What came to be otherwise."""

    parts: tuple[OutputElement, ...]
    """Parts, by their element, that are to be written anew."""
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
        """Carry out edits in the texts and in the run; None when only a full run can tell.

        `has_edited` says then whether the store holds all of them, or none.
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
            _tell(reason)
            self.texts.take_back()
            return None
        self.has_edited = True
        try:
            for one in edited.values():
                work.take(one.path, one.before, self.texts.site(one.path, one.before.id))
            return work.finish(self.texts)
        except Exception as reason:  # noqa: BLE001 - as above
            _tell(reason)
            self.texts.distrust()
            return None

    def set_arguments(self, old: Mapping[str, str], new: Mapping[str, str]) -> Patch | None:
        """Give arguments other values; None when only a full run can tell what that does."""
        if old.keys() != new.keys():
            return None
        work = _Work(self)
        try:
            for name, value in new.items():
                if value != old[name]:
                    work.set_argument(self.evaluation.texts.arguments[name], value)
            return work.finish(self.texts)
        except Exception as reason:  # noqa: BLE001 - as above
            _tell(reason)
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
        """Look at what has another value now."""
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
        """Evaluate what depends on all that, and say what came to be otherwise."""
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
        """The mapping or list of plain values that a scalar stands in."""
        container = self._run.evaluation.store.held(path)[1]
        if not site.path or path not in self._run.record.yaml:
            raise PatchRefused("the file is one value")
        for key in site.path[:-1]:
            container = _item(container, key)
        return container


def _tell(reason: Exception) -> None:
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
