"""What a finished run says about each drafted text: its values, who read it, what it shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from studio.description.run_record import consumers_of
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from studio.description.drafts import Draft, FileDrafts
    from studio.description.run_record import (
        Binding,
        Consumer,
        Input,
        KeyPath,
        RunRecord,
        YamlReads,
    )

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
        self._bindings: dict[_BindingKey, list[Binding]] = {}
        for binding in record.bindings:
            if binding.kind is not None:
                self._bindings.setdefault(_key(binding), []).append(binding)

    def of_file(self, path: str, file: FileDrafts) -> Iterator[tuple[Draft, Seen]]:
        """Each draft of a file with what the run saw of it."""
        document = self._record.yaml.get(path)
        if document is not None and path not in self._record.trees:
            yield from _of_yaml(file, document)
            return
        elements = self._record.trees[path].elements
        for draft in file.drafts:
            if draft.kind is SiteKind.LITERAL:
                keys = self._record.part_keys.get(elements[draft.ordinal], ())
                yield draft, _of_literal(draft.text, keys)
            else:
                yield draft, self._of_binding(path, draft)

    def _of_binding(self, path: str, draft: Draft) -> Seen:
        name = draft.name if draft.kind is SiteKind.PARAM_DEFAULT else ""
        bindings = self._bindings.get((path, draft.ordinal, draft.attribute, name))
        if not bindings:
            return NOT_READ
        values = dict.fromkeys(value for one in bindings for value in one.values)
        return Seen(tuple(values), *_shared(bindings))


def _key(binding: Binding) -> _BindingKey:
    element = binding.element
    name = binding.name if binding.kind is SiteKind.PARAM_DEFAULT else ""
    return (element.tree.path, element.ordinal, binding.attribute, name)


def _shared(
    inputs: Iterable[Input],
) -> tuple[int, tuple[Consumer, ...], tuple[str, ...]]:
    """Reads, consumers and comparisons of one text that was met under several names."""
    inputs = tuple(inputs)
    reads = sum(one.reads for one in inputs)
    consumers = dict.fromkeys(consumer for one in inputs for consumer in consumers_of(one))
    compared = dict.fromkeys(text for one in inputs for text in _compared_with(one))
    return reads, tuple(consumers), tuple(compared)


def _compared_with(start: Input) -> Iterator[str]:
    """What conditions compare it with, itself or under the name that it was passed on as."""
    yield from start.compared
    for dependent in start.dependents:
        if _passes_on(dependent, start):
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


def _of_yaml(file: FileDrafts, document: YamlReads) -> Iterator[tuple[Draft, Seen]]:
    """Scalars by key path; what was read through an alias counts where it is written."""
    written = {draft.path for draft in file.drafts}
    aliases = dict(file.aliases)
    inputs: dict[KeyPath, list[Input]] = {}
    for path, scalar in document.values.items():
        inputs.setdefault(written_at(path, written, aliases), []).append(scalar)
    whole = {written_at(path, written, aliases) for path in document.whole}
    for draft in file.drafts:
        reads, consumers, compared = _shared(inputs.get(draft.path, ()))
        reads += sum(draft.path[:size] in whole for size in range(len(draft.path) + 1))
        values = (draft.text,) if reads else ()
        yield draft, Seen(values, reads, consumers, compared)


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
