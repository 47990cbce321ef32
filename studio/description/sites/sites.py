"""The editable texts of a finished run, each with its place, what it came to, and its widget.

What only the bytes tell is kept per file and drafted anew only when they change; a site that came
out the same as in the run before is the same object.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

from studio.description.sites.drafts import Draft, FileDrafts, draft_xml, draft_yaml
from studio.description.sites.run_reads import RunReads, Seen
from studio.description.sites.widgets import infer_widget, keep_range
from studio.description.syntax.number_text import parse_number
from studio.description.values import Site, SiteKind

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from studio.description.evaluator.run_record import RunRecord
    from studio.description.values import Widget


class EditedTexts(Protocol):
    """The texts behind sites, as edits have left them."""

    def written(self, path: str, site: str) -> Draft:
        """A site as it is now, but for its span."""
        ...

    def now(self, path: str, site: str) -> Draft:
        """A site as it is now."""
        ...


@dataclass(frozen=True, slots=True)
class _Built:
    """A site and what it was built from, to tell whether it must be built again."""

    draft: Draft
    seen: Seen
    site: Site
    first: Widget
    """As it was inferred for the first time: a value that comes back gets its range back."""


class SiteBuilder:
    """Builds the sites of the runs of one session.

    Args:
        known: Ids of attributes that were sites in a session before.
    """

    def __init__(self, known: Iterable[str] = ()) -> None:
        self._known = frozenset(known)
        self._files: dict[str, FileDrafts] = {}
        self._built: dict[str, _Built] = {}
        self.reads: RunReads
        """What the last run says of the texts."""

    @property
    def files(self) -> Mapping[str, FileDrafts]:
        """The drafts of each file as of the last run."""
        return self._files

    def build(self, record: RunRecord) -> list[Site]:
        """All sites, file by file in the order in which the run read them, then top to bottom.

        Every arg and property of the files is one, also where the run did not come by, and every
        scalar of the YAML files that were read.
        """
        self.reads = reads = RunReads(record)
        self._files = dict(self._drafted(record))
        self._built = {
            draft.id: self._build(draft, seen)
            for path, file in self._files.items()
            for draft, seen in reads.of_file(path, file)
        }
        return [one.site for one in self._built.values()]

    def patch(self, sites: Mapping[str, str], texts: EditedTexts) -> tuple[Site, ...]:
        """Those of some sites that are other ones now, given by id with their file.

        One that has only moved with an edit before it is none.
        """
        changed: list[Site] = []
        for name, path in sites.items():
            before, draft = self._built[name], texts.written(path, name)
            seen = self.reads.seen(path, self._files[path], draft)
            is_same_text = (draft.text, draft.place) == (before.draft.text, before.draft.place)
            if not is_same_text or seen != before.seen:
                self._built[name] = built = self._build(texts.now(path, name), seen)
                changed.append(built.site)
        return tuple(changed)

    def _drafted(self, record: RunRecord) -> Iterator[tuple[str, FileDrafts]]:
        """The drafts of each file that was read, those of unchanged bytes as they were."""
        for path in dict.fromkeys(record.files):
            tree, document = record.trees.get(path), record.yaml.get(path)
            data = tree.data if tree else document.data if document else None
            known = self._files.get(path)
            if known is not None and known.data == data:
                yield path, known
            elif tree is not None:
                yield path, draft_xml(tree, known, self._known)
            elif document is not None:
                yield path, draft_yaml(path, document.data)

    def _build(self, draft: Draft, seen: Seen) -> _Built:
        before = self._built.get(draft.id)
        if before is None or before.draft.name != draft.name:
            site = _site(draft, seen, ())
            return _Built(draft, seen, site, site.widget)
        if before.seen == seen and (before.draft is draft or before.draft == draft):
            return before
        if _is_as_before(before, draft, seen):
            site = replace(before.site, place=draft.place, span=draft.span, reads=seen.reads)
        else:
            site = _site(draft, seen, (before.first, before.site.widget))
        return _Built(draft, seen, site, before.first)


def _is_as_before(before: _Built, draft: Draft, seen: Seen) -> bool:
    """Whether a site has only moved, or got or lost readers of the same kind."""
    known = before.draft
    return (
        (known.text, known.group, known.annotation, known.element_path)
        == (draft.text, draft.group, draft.annotation, draft.element_path)
    ) and before.seen._replace(reads=0) == seen._replace(reads=0)


def _site(draft: Draft, seen: Seen, before: tuple[Widget, ...]) -> Site:
    value = seen.values[0] if seen.values else ""
    return Site(
        id=draft.id,
        kind=draft.kind,
        name=draft.name,
        place=draft.place,
        span=draft.span,
        text=draft.text,
        value=value,
        number=parse_number(value),
        reads=seen.reads,
        widget=_widget(draft, seen, value, before),
        group=seen.owner.partition(":")[2] or draft.group,
        owner=seen.owner,
        values=seen.values if len(seen.values) > 1 else (),
    )


def _widget(draft: Draft, seen: Seen, value: str, before: tuple[Widget, ...]) -> Widget:
    is_literal = draft.kind is SiteKind.LITERAL
    consumers = ((draft.element_path, draft.attribute),) if is_literal else seen.consumers
    name = "" if is_literal else draft.name
    widget = infer_widget(name, draft.text, value, draft.annotation, consumers, seen.compared)
    return keep_range(widget, before, value or draft.text)
