"""Two sessions side by side: one that patches, one that always runs in full."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.editing.sources import Sources
from studio.description.session import Session
from studio.description.values import (
    ArgumentsRequest,
    EditRequest,
    Expansion,
    Failure,
    OpenRequest,
)
from studio.errors import StaleEditError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.description.session import Answer, Request
    from studio.description.values import Edit, Part, ReadPolicy, Site


class FullSession(Session):
    """A session that makes a full run for each request."""

    def answer(self, request: Request) -> Answer:
        """Answer as if no run came before."""
        self._live = None
        return super().answer(request)


@dataclass
class Told:
    """What somebody knows who has heard all answers of a session."""

    sources: Sources
    parts: dict[str, Part] = field(default_factory=dict[str, "Part"])
    order: tuple[str, ...] = ()
    sites: tuple[str, ...] = ()
    last: Expansion | None = None
    failure: Failure | None = None

    def take(self, answer: Answer) -> None:
        """Hear one."""
        if isinstance(answer, Failure):
            self.failure = answer
            return
        self.failure = None
        self.parts.update((part.key, part) for part in answer.changed_parts)
        self.order = self.order if answer.part_order is None else answer.part_order
        self.sites = self.sites if answer.site_order is None else answer.site_order
        self.sources.adopt(answer, self.sources.spans.version)
        self.last = replace(
            answer,
            part_order=None,
            changed_parts=(),
            site_order=None,
            changed_sites=(),
            is_patch=False,
        )

    def site(self, name: str) -> Site:
        """A site as it is now."""
        return self.sources.spans.site(name)

    def place(self, name: str) -> object:
        """Where a site is written now and what stands there; None when that is not known."""
        try:
            site, span = self.site(name), self.sources.spans.span(name)
        except StaleEditError:
            return None
        return site.place, span, self.sources.current_text(name)

    def everything(self) -> dict[str, object]:
        """All of it, to be compared."""
        parts = {key: (self.parts[key].xml, self.parts[key].calls) for key in self.order}
        sites = {name: self.site(name) for name in self.sites}
        return {"run": self.last, "failure": self.failure, **parts, **sites}


class SideBySide:
    """The same requests to both; `differences` says where they disagree."""

    def __init__(
        self, file: Path, policy: ReadPolicy, arguments: Mapping[str, str] | None = None
    ) -> None:
        self.request = OpenRequest(str(file), dict(arguments or {}), policy, {})
        self.patching, self.told = _opened(self.request)
        self.full, self.full_told = _opened(self.request, FullSession)
        self.patched = self.ran = 0
        self.last: Answer | None = None
        """What the patching one answered last."""

    def edit(self, site: str, text: str) -> bool:
        """Write a text at a site; whether it was patched."""
        edit = self.told.sources.edit_site(site, text)
        self.full_told.sources.edit(edit, "edit")
        return self.send(EditRequest((edit,)))

    def undo(self) -> bool:
        """Take the last edit back; whether that was patched."""
        change, same = self.told.sources.undo(), self.full_told.sources.undo()
        assert change is not None
        assert same is not None
        return self.send(EditRequest(change.edits))

    def splice(self, *edits: Edit) -> bool:
        """Edit bytes; whether that was patched."""
        for edit in edits:
            self.told.sources.edit(edit, "edit")
            self.full_told.sources.edit(edit, "edit")
        return self.send(EditRequest(edits))

    def send(self, request: Request) -> bool:
        """Ask both the same; whether the one patched."""
        if isinstance(request, ArgumentsRequest):
            self.request = replace(self.request, arguments=request.arguments)
        answer = self.last = self.patching.answer(request)
        self.told.take(answer)
        self.full_told.take(self.full.answer(request))
        is_patch = isinstance(answer, Expansion) and answer.is_patch
        self.patched += is_patch
        self.ran += not is_patch
        return is_patch

    def patched_answer(self) -> Expansion:
        """What the patching one answered last."""
        assert isinstance(self.last, Expansion)
        return self.last

    def differences(self) -> list[str]:
        """What the two do not agree about."""
        ours, theirs = self.told.everything(), self.full_told.everything()
        if ours == theirs:
            return []
        keys = dict.fromkeys((*ours, *theirs))
        return [
            f"{key}:\n  patched {ours.get(key)}\n  full    {theirs.get(key)}"
            for key in keys
            if ours.get(key) != theirs.get(key)
        ]

    def misplaced(self) -> list[str]:
        """Sites that who opens these texts now finds elsewhere, or with another text.

        `differences` cannot tell: there both sides hear answers, and move sites between them.
        """
        overlay = self.told.sources.overlay()
        anew = _opened(replace(self.request, overlay=overlay), text=self.told.sources.text)[1]
        found = {name: (self.told.place(name), anew.place(name)) for name in anew.sites}
        return [f"{name}: {ours}, anew {new}" for name, (ours, new) in found.items() if ours != new]


def _opened(
    request: OpenRequest,
    kind: type[Session] = Session,
    text: Callable[[str], bytes] | None = None,
) -> tuple[Session, Told]:
    session = kind(request)
    answer = session.run()
    assert isinstance(answer, Expansion), answer

    def read(file: Path) -> bytes:
        return text(str(file)) if text else file.read_bytes()

    told = Told(Sources(read, Path.resolve))
    told.take(answer)
    return session, told
