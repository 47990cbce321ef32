"""What a finished run says about each drafted text: its values, who read it, what it shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from studio.description.evaluator.run_record import YamlScalar
from studio.description.sites.reach import Reach
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from studio.description.evaluator.graph import Consumer
    from studio.description.evaluator.run_record import (
        Binding,
        Input,
        KeyPath,
        RunRecord,
        YamlReads,
    )
    from studio.description.sites.drafts import Draft, FileDrafts

_BindingKey: TypeAlias = tuple[str, int, str, str]
"""File, ordinal of the element, attribute; for `params` the parameter's name."""
_OWNERS = ("link:", "joint:")
_MERGE = "<<"
_ALIAS_STEPS = 16


class Seen(NamedTuple):
    """What a run saw of one text; `values` are distinct, as xacro prints them."""

    values: tuple[str, ...] = ()
    reads: int = 0
    consumers: tuple[Consumer, ...] = ()
    compared: tuple[str, ...] = ()
    owner: str = ""


NOT_READ = Seen()


class RunReads:
    """One run record, asked by drafts."""

    def __init__(self, record: RunRecord) -> None:
        self._record = record
        self._reach = Reach()
        self._yaml: dict[str, _YamlInputs] = {}
        self._bindings: dict[_BindingKey, list[Binding]] = {}
        for binding in record.bindings:
            if binding.kind is not None:
                self._bindings.setdefault(_key(binding), []).append(binding)

    def readers_changed(self, one: Input) -> None:
        """Look at an input anew."""
        self._reach.forget(one)

    def bindings(self, path: str, draft: Draft) -> list[Binding]:
        """What the run bound the text of a draft to."""
        name = draft.name if draft.kind is SiteKind.PARAM_DEFAULT else ""
        return self._bindings.get((path, draft.ordinal, draft.attribute, name), [])

    def site_of(
        self, one: Binding | YamlScalar, files: Mapping[str, FileDrafts]
    ) -> tuple[str, str | None]:
        """The file and site id of what was read; None when it is no site."""
        if isinstance(one, YamlScalar):
            path = one.document
            return path, self._inputs_of(path, files[path]).site_of(one.path)
        path, ordinal, attribute, name = _key(one)
        return path, f"{path}#{ordinal}@{attribute}" + (f":{name}" if name else "")

    def of_file(self, path: str, file: FileDrafts) -> Iterator[tuple[Draft, Seen]]:
        """Each draft of a file with what the run saw of it."""
        return ((draft, self.seen(path, file, draft)) for draft in file.drafts)

    def seen(self, path: str, file: FileDrafts, draft: Draft) -> Seen:
        """What the run saw of a draft of a file."""
        if draft.kind is SiteKind.YAML:
            return self._of_yaml(path, file, draft)
        if draft.kind is SiteKind.LITERAL:
            element = self._record.trees[path].elements[draft.ordinal]
            return _of_literal(draft.text, self._record.part_keys.get(element, ()))
        bindings = self.bindings(path, draft)
        if not bindings:
            return NOT_READ
        values = dict.fromkeys(value for one in bindings for value in one.values)
        return Seen(tuple(values), *self._shared(bindings))

    def _of_yaml(self, path: str, file: FileDrafts, draft: Draft) -> Seen:
        inputs = self._inputs_of(path, file)
        reads, consumers, compared = self._shared(inputs.of(draft.path))
        reads += inputs.reads_of_whole(draft.path)
        return Seen((draft.text,) if reads else (), reads, consumers, compared)

    def _inputs_of(self, path: str, file: FileDrafts) -> _YamlInputs:
        inputs = self._yaml.get(path)
        if inputs is None:
            inputs = self._yaml[path] = _YamlInputs(file, self._record.yaml[path])
        return inputs

    def _shared(self, inputs: Iterable[Input]) -> tuple[int, tuple[Consumer, ...], tuple[str, ...]]:
        """Reads, consumers and comparisons of one text that was met under several names."""
        inputs, reach = tuple(inputs), self._reach
        reads = sum(reach.links(one).reads for one in inputs)
        consumers = dict.fromkeys(found for one in inputs for found in reach.consumers(one))
        compared = dict.fromkeys(text for one in inputs for text in _compared_with(one, reach))
        return reads, tuple(consumers), tuple(compared)


def _key(binding: Binding) -> _BindingKey:
    element = binding.element
    name = binding.name if binding.kind is SiteKind.PARAM_DEFAULT else ""
    return (element.tree.path, element.ordinal, binding.attribute, name)


def _compared_with(start: Input, reach: Reach) -> Iterator[str]:
    """What conditions compare it with, itself or under the name that it was passed on as."""
    yield from start.compared
    for dependent in reach.links(start).dependents:
        if dependent.compared and _passes_on(dependent, start):
            yield from dependent.compared


def _passes_on(dependent: Input, start: Input) -> bool:
    """Whether `dependent` is nothing but the value of `start`: `${x}` or `$(arg x)`."""
    text, name = getattr(dependent, "text", None), getattr(start, "name", None)
    return bool(name) and text in {f"${{{name}}}", f"$(arg {name})"}


def _of_literal(text: str, keys: tuple[str, ...]) -> Seen:
    if not keys:
        return NOT_READ
    owners = [key for key in keys if key.startswith(_OWNERS)]
    return Seen((text,), len(keys), owner=owners[0] if len(owners) == len(keys) == 1 else "")


class _YamlInputs:
    """What was read of one YAML file, by the paths where it is written."""

    def __init__(self, file: FileDrafts, document: YamlReads) -> None:
        self._ids = {draft.path: draft.id for draft in file.drafts}
        written, aliases = set(self._ids), dict(file.aliases)
        self._written = {one: written_at(one, written, aliases) for one in document.values}
        self._inputs: dict[KeyPath, list[Input]] = {}
        for path, scalar in document.values.items():
            self._inputs.setdefault(self._written[path], []).append(scalar)
        self._whole = {written_at(path, written, aliases) for path in document.whole}

    def of(self, path: KeyPath) -> list[Input]:
        """The values read there; what was read through an alias counts where it is written."""
        return self._inputs.get(path, [])

    def site_of(self, path: KeyPath) -> str | None:
        """The site that a value was read from; a container is none."""
        return self._ids.get(self._written.get(path, path))

    def reads_of_whole(self, path: KeyPath) -> int:
        """How many containers around a path were read at once."""
        if not self._whole:
            return 0
        return sum(path[:size] in self._whole for size in range(len(path) + 1))


def written_at(path: KeyPath, written: set[KeyPath], aliases: Mapping[KeyPath, KeyPath]) -> KeyPath:
    """Follow aliases and merge keys from a path as read to the path as written."""
    for _ in range(_ALIAS_STEPS):
        if path in written:
            return path
        followed = _followed(path, written, aliases)
        if followed is None:
            return path
        path = followed
    return path


def _followed(
    path: KeyPath, written: set[KeyPath], aliases: Mapping[KeyPath, KeyPath]
) -> KeyPath | None:
    for size in range(len(path), 0, -1):
        if path[:size] in aliases:
            return (*aliases[path[:size]], *path[size:])
    for size in range(len(path) - 1, -1, -1):
        merge = (*path[:size], _MERGE)
        if merge in aliases:
            return (*aliases[merge], *path[size:])
        if (*merge, *path[size:]) in written:
            return (*merge, *path[size:])
    return None
