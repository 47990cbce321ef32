"""Which editable text each thing that a traced run read is, and the other way round."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from studio.description.sites.drafts import draft_yaml
from studio.description.sites.run_reads import written_at
from studio.description.values import SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from studio.description.evaluator.run_record import Input, KeyPath, YamlReads, YamlScalar
    from studio.description.origins.tracing import Trace, TracedBinding
    from studio.description.sites.drafts import Draft


def site_of_binding(binding: TracedBinding) -> str:
    """Id of the text of a binding, were it one that can be edited; empty for what never is."""
    start = f"{binding.element.tree.path}#{binding.element.ordinal}@"
    match binding.kind:
        case None:
            return ""
        case SiteKind.PARAM_DEFAULT:
            return f"{start}params:{binding.name}"
        case _:
            return start + binding.attribute


class YamlSites:
    """The scalars of the YAML files that a traced run read."""

    def __init__(self, yaml: Mapping[str, YamlReads]) -> None:
        self._yaml = yaml
        self._files: dict[str, _YamlFile] = {}

    def draft_of(self, scalar: YamlScalar) -> Draft | None:
        """Where a value that was read is written; None for a mapping or a list."""
        file = self._file(scalar.document)
        return file.drafts.get(written_at(scalar.path, file.written, file.aliases))

    def inputs_by_site(self) -> Iterator[tuple[str, Input]]:
        """Every scalar that was read, itself or with all that stands around it."""
        for path, reads in self._yaml.items():
            file = self._file(path)
            whole = {written_at(one, file.written, file.aliases) for one in reads.whole}
            for scalar in reads.values.values():
                at = written_at(scalar.path, file.written, file.aliases)
                if at in file.drafts:
                    yield file.drafts[at].id, scalar
                elif at in whole:
                    yield from ((one.id, scalar) for one in file.below(at))

    def _file(self, path: str) -> _YamlFile:
        if path not in self._files:
            self._files[path] = _yaml_file(path, self._yaml[path].data)
        return self._files[path]


class _YamlFile:
    """The drafts of one file by key path."""

    def __init__(self, path: str, data: bytes) -> None:
        drafted = draft_yaml(path, data)
        self.drafts = {draft.path: draft for draft in drafted.drafts}
        self.written = set(self.drafts)
        self.aliases = dict(drafted.aliases)

    def below(self, path: KeyPath) -> Iterator[Draft]:
        return (one for at, one in self.drafts.items() if at[: len(path)] == path)


@lru_cache(maxsize=64)
def _yaml_file(path: str, data: bytes) -> _YamlFile:
    """Drafting takes longer than the run: unchanged bytes are not drafted again."""
    return _YamlFile(path, data)


def inputs_by_site(trace: Trace) -> dict[str, list[Input]]:
    """What was read of each text that has a name or a key path, by the text's site id."""
    found: dict[str, list[Input]] = {}
    for binding in trace.bindings:
        if site := site_of_binding(binding):
            found.setdefault(site, []).append(binding)
    for site, scalar in YamlSites(trace.yaml).inputs_by_site():
        found.setdefault(site, []).append(scalar)
    return found
