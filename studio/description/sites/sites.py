"""The editable texts of a finished run, each with its place, its value, and its widget.

What the bytes alone show is kept per file and read again only when they change. A site that came
out the same as in the run before is the same object.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

from studio.description.evaluator.graph import YamlValue
from studio.description.sites.file_sites import FileSite, FileSites, xml_sites, yaml_sites
from studio.description.sites.widgets import infer_widget, keep_range, parse_number
from studio.description.values import Site, SiteKind

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from studio.description.evaluator.graph import Binding, Consumer, Input, YamlReads
    from studio.description.evaluator.runs import RunRecord
    from studio.description.sites.file_sites import LiveSites
    from studio.description.syntax.yaml_spans import KeyPath
    from studio.description.values import Widget

CONSUMERS_KEPT: Final = 8
_BindingKey: TypeAlias = tuple[str, int, str, str]
"""File, ordinal of the element, attribute; for `params` the parameter's name."""
_OWNERS = ("link:", "joint:")
_MERGE = "<<"
_ALIAS_STEPS = 16


class Links(NamedTuple):
    """Readers of one input: `reads` counts texts, of the consumers there are the first few."""

    reads: int
    consumers: tuple[Consumer, ...]
    dependents: tuple[Binding, ...]
    """Named texts that were made from it."""


class Reach:
    """The links of one state of a graph, each found once."""

    def __init__(self) -> None:
        self._links: dict[Input, Links] = {}
        self._consumers: dict[Input, tuple[Consumer, ...]] = {}

    def forget(self, one: Input) -> None:
        """Examine an input again: it, or what is made of it, got or lost readers."""
        self._links.pop(one, None)
        self._consumers.pop(one, None)

    def links(self, one: Input) -> Links:
        """Return the readers of an input."""
        links = self._links.get(one)
        if links is None:
            links = self._links[one] = _links_of(one)
        return links

    def consumers(self, start: Input) -> tuple[Consumer, ...]:
        """The attributes that an input shapes, through any number of properties, nearest first.

        Only the first few.
        """
        found = self._consumers.get(start)
        if found is None:
            found = self._consumers[start] = tuple(self._nearest(start))[:CONSUMERS_KEPT]
        return found

    def _nearest(self, start: Input) -> dict[Consumer, None]:
        """Consumers from the nearest on, until there are enough."""
        found: dict[Consumer, None] = {}
        seen: set[Input] = {start}
        front: list[Input] = [start]
        while front:
            reached: list[Input] = []
            for one in front:
                _, consumers, dependents = self._links.get(one) or self.links(one)
                if consumers:
                    found.update(dict.fromkeys(consumers))
                    if len(found) >= CONSUMERS_KEPT:
                        return found
                for dependent in dependents:
                    if dependent not in seen:
                        seen.add(dependent)
                        reached.append(dependent)
            front = reached
        return found


def _links_of(one: Input) -> Links:
    readings = one.readings
    consumers: dict[Consumer, None] = {}
    dependents: dict[Binding, None] = {}
    for record in readings:
        made = record.made
        if made is not None and made.binding is not None:
            dependents[made.binding] = None
        elif record.consumer is not None and len(consumers) < CONSUMERS_KEPT:
            consumers[record.consumer] = None
    return Links(len(readings), tuple(consumers), tuple(dependents))


class Seen(NamedTuple):
    """What a run made of one text; `values` are distinct, as xacro prints them."""

    values: tuple[str, ...] = ()
    reads: int = 0
    consumers: tuple[Consumer, ...] = ()
    compared: tuple[str, ...] = ()
    owner: str = ""


NOT_READ = Seen()


class RunReads:
    """Finds in one run record what belongs to a site."""

    def __init__(self, record: RunRecord) -> None:
        self._record = record
        self._reach = Reach()
        self._yaml: dict[str, _YamlInputs] = {}
        self._bindings: dict[_BindingKey, list[Binding]] = {}
        for binding in record.bindings:
            if binding.kind is not None:
                self._bindings.setdefault(_key(binding), []).append(binding)

    def readers_changed(self, one: Input) -> None:
        """Examine an input again."""
        self._reach.forget(one)

    def bindings(self, path: str, site: FileSite) -> list[Binding]:
        """Return what the run bound the text of a site to."""
        name = site.name if site.kind is SiteKind.PARAM_DEFAULT else ""
        return self._bindings.get((path, site.ordinal, site.attribute, name), [])

    def site_of(
        self, one: Binding | YamlValue, files: Mapping[str, FileSites]
    ) -> tuple[str, str | None]:
        """Return the file and site id of what was read; None when it is no site."""
        if isinstance(one, YamlValue):
            path = one.document
            return path, self._inputs_of(path, files[path]).site_of(one.path)
        path, ordinal, attribute, name = _key(one)
        return path, f"{path}#{ordinal}@{attribute}" + (f":{name}" if name else "")

    def of_file(self, path: str, file: FileSites) -> Iterator[tuple[FileSite, Seen]]:
        """Yield each site of a file with what the run made of it."""
        return ((site, self.seen(path, file, site)) for site in file.sites)

    def seen(self, path: str, file: FileSites, site: FileSite) -> Seen:
        """Return what the run made of a site of a file."""
        if site.kind is SiteKind.YAML:
            return self._of_yaml(path, file, site)
        if site.kind is SiteKind.LITERAL:
            element = self._record.trees[path].elements[site.ordinal]
            return _of_literal(site.text, self._record.part_keys.get(element, ()))
        bindings = self.bindings(path, site)
        if not bindings:
            return NOT_READ
        values = dict.fromkeys(value for one in bindings for value in one.values)
        return Seen(tuple(values), *self._shared(bindings))

    def _of_yaml(self, path: str, file: FileSites, site: FileSite) -> Seen:
        inputs = self._inputs_of(path, file)
        reads, consumers, compared = self._shared(inputs.of(site.path))
        reads += inputs.reads_of_whole(site.path)
        return Seen((site.text,) if reads else (), reads, consumers, compared)

    def _inputs_of(self, path: str, file: FileSites) -> _YamlInputs:
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
    """Yield the texts that conditions compare it with, also under names it was passed on as."""
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

    def __init__(self, file: FileSites, document: YamlReads) -> None:
        self._ids = {site.path: site.id for site in file.sites}
        written, aliases = set(self._ids), dict(file.aliases)
        self._written = {one: path_as_written(one, written, aliases) for one in document.values}
        self._inputs: dict[KeyPath, list[Input]] = {}
        for path, scalar in document.values.items():
            self._inputs.setdefault(self._written[path], []).append(scalar)
        self._whole = {path_as_written(path, written, aliases) for path in document.whole}

    def of(self, path: KeyPath) -> list[Input]:
        """Return the values read there; through an alias, where it is written."""
        return self._inputs.get(path, [])

    def site_of(self, path: KeyPath) -> str | None:
        """Return the site that a value was read from; a container is none."""
        return self._ids.get(self._written.get(path, path))

    def reads_of_whole(self, path: KeyPath) -> int:
        """Return how many containers around a path were read as a whole."""
        if not self._whole:
            return 0
        return sum(path[:size] in self._whole for size in range(len(path) + 1))


def path_as_written(
    path: KeyPath, written: set[KeyPath], aliases: Mapping[KeyPath, KeyPath]
) -> KeyPath:
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


@dataclass(frozen=True, slots=True)
class _Built:
    """A site and what it was built from, to know whether it must be built again."""

    in_file: FileSite
    seen: Seen
    site: Site
    first: Widget
    """As it was first inferred: a value that comes back gets its range back."""


class SiteBuilder:
    """Builds the sites of the runs of one session.

    Args:
        known: Ids of attributes that were sites in a session before.
    """

    def __init__(self, known: Iterable[str] = ()) -> None:
        self._known = frozenset(known)
        self._files: dict[str, FileSites] = {}
        self._built: dict[str, _Built] = {}
        self.reads: RunReads
        """What the last run read of the texts."""

    @property
    def files(self) -> Mapping[str, FileSites]:
        """The sites of each file as of the last run."""
        return self._files

    def build(self, record: RunRecord) -> list[Site]:
        """Return all sites, file by file in the order in which the run read them, from top to end.

        Every arg and property of the files is one, even if the run did not reach it, and every
        scalar of the YAML files that were read.
        """
        self.reads = reads = RunReads(record)
        self._files = dict(self._read(record))
        self._built = {
            site.id: self._build(site, seen)
            for path, file in self._files.items()
            for site, seen in reads.of_file(path, file)
        }
        return [one.site for one in self._built.values()]

    def patch(self, sites: Mapping[str, str], live: Callable[[str], LiveSites]) -> tuple[Site, ...]:
        """Return those of some sites that changed.

        One that has only moved with an edit before it has not.

        Args:
            sites: Their files by their ids.
            live: Returns the sites of a file as edits have left them.
        """
        changed: list[Site] = []
        for name, path in sites.items():
            before, in_file = self._built[name], live(path).without_span(name)
            seen = self.reads.seen(path, self._files[path], in_file)
            known = before.in_file
            is_same_text = (in_file.text, in_file.place) == (known.text, known.place)
            if not is_same_text or seen != before.seen:
                self._built[name] = built = self._build(live(path).by_id(name), seen)
                changed.append(built.site)
        return tuple(changed)

    def _read(self, record: RunRecord) -> Iterator[tuple[str, FileSites]]:
        """Yield the sites of each file that was read, those of unchanged bytes as they were."""
        for path in dict.fromkeys(record.files):
            tree, document = record.trees.get(path), record.yaml.get(path)
            data = tree.data if tree else document.data if document else None
            known = self._files.get(path)
            if known is not None and known.data == data:
                yield path, known
            elif tree is not None:
                yield path, xml_sites(tree, known, self._known)
            elif document is not None:
                yield path, yaml_sites(path, document.data)

    def _build(self, in_file: FileSite, seen: Seen) -> _Built:
        before = self._built.get(in_file.id)
        if before is None or before.in_file.name != in_file.name:
            site = _site(in_file, seen, ())
            return _Built(in_file, seen, site, site.widget)
        if before.seen == seen and (before.in_file is in_file or before.in_file == in_file):
            return before
        if _is_as_before(before, in_file, seen):
            site = replace(before.site, place=in_file.place, span=in_file.span, reads=seen.reads)
        else:
            site = _site(in_file, seen, (before.first, before.site.widget))
        return _Built(in_file, seen, site, before.first)


def _is_as_before(before: _Built, in_file: FileSite, seen: Seen) -> bool:
    """Whether a site has only moved, or got or lost readers of the same kind."""
    known = before.in_file
    return (
        (known.text, known.group, known.annotation, known.element_path)
        == (in_file.text, in_file.group, in_file.annotation, in_file.element_path)
    ) and before.seen._replace(reads=0) == seen._replace(reads=0)


def _site(in_file: FileSite, seen: Seen, before: tuple[Widget, ...]) -> Site:
    value = seen.values[0] if seen.values else ""
    return Site(
        id=in_file.id,
        kind=in_file.kind,
        name=in_file.name,
        place=in_file.place,
        span=in_file.span,
        text=in_file.text,
        value=value,
        number=parse_number(value),
        reads=seen.reads,
        widget=_widget(in_file, seen, value, before),
        group=seen.owner.partition(":")[2] or in_file.group,
        owner=seen.owner,
        values=seen.values if len(seen.values) > 1 else (),
    )


def _widget(in_file: FileSite, seen: Seen, value: str, before: tuple[Widget, ...]) -> Widget:
    is_literal = in_file.kind is SiteKind.LITERAL
    consumers = ((in_file.element_path, in_file.attribute),) if is_literal else seen.consumers
    name = "" if is_literal else in_file.name
    widget = infer_widget(name, in_file.text, value, in_file.annotation, consumers, seen.compared)
    return keep_range(widget, before, value or in_file.text)
