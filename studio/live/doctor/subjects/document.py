"""The open description: its problems, missing meshes among them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.live.doctor.seen import Looked, short
from studio.problems import Severity
from studio.protocol.doctor import Concern, Finding

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.live.doctor.seen import Seen
    from studio.protocol.doctor import Level, SubjectName

SUBJECT: Final[SubjectName] = "document"
_LEVELS: Final[dict[Severity, Level]] = {Severity.ERROR: "error", Severity.WARNING: "warn"}
_SAID_MAX: Final = 40


def looked_at(seen: Seen) -> Looked | None:
    """The description."""
    if seen.document is None:
        return None
    return Looked(1, f"{short(seen.document.title)}, {len(seen.document.links)} links")


def findings(seen: Seen) -> Iterator[Finding]:
    """Repeat its problems that hinder."""
    if seen.document is None:
        return
    hindering = [one for one in seen.document.problems if one.severity in _LEVELS]
    hindering.sort(key=lambda one: one.severity is not Severity.ERROR)
    for problem in hindering[:_SAID_MAX]:
        place = problem.place
        where = f"{place.file.rpartition('/')[2]}:{place.line}" if place and place.line else ""
        yield Finding(
            code="problem",
            level=_LEVELS[problem.severity],
            subject=SUBJECT,
            sentence=short(problem.sentence, 500),
            evidence=tuple(one for one in (where, problem.code) if one) or (seen.document.title,),
            about=(Concern(kind="document", name=seen.document.id),),
        )
