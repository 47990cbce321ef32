"""An examination: all subjects over the facts, the gravest finding first, within bounds."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol, cast, get_args

from studio.live.doctor.seen import OF_ONE_CODE_MAX, short
from studio.problems import modules_of
from studio.protocol.doctor import FINDINGS_MAX, Finding, Level, SubjectName, SubjectView

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator, Mapping

    from studio.live.doctor.seen import Looked, Seen

_LEVELS: Final[tuple[Level, ...]] = get_args(Level)
_SUBJECTS: Final[tuple[SubjectName, ...]] = get_args(SubjectName)
OF_WHO_ASKS: Final[frozenset[SubjectName]] = frozenset(
    {"frames", "displays", "document", "browser"}
)
"""Subjects that conclude of the document or the browser, too; all others are the same for all."""
SHARED: Final = frozenset(_SUBJECTS) - OF_WHO_ASKS
_SENTENCE_MAX: Final = 700
_LINE_MAX: Final = 400
_LINES_MAX: Final = 12


class Subject(Protocol):
    """A file of `subjects/`."""

    SUBJECT: SubjectName

    def findings(self, seen: Seen) -> Iterator[Finding]:
        """Yield what is wrong."""
        ...

    def looked_at(self, seen: Seen) -> Looked | None:
        """Return what there was to look at; None: nothing."""
        ...


class Examination(NamedTuple):
    """What was found.

    Attributes:
        findings: The gravest first, then in the order of subjects.
        more: Findings that are left out.
        subjects: What was looked at, in their order.
    """

    findings: tuple[Finding, ...]
    more: int
    subjects: tuple[SubjectView, ...]


@cache
def subjects() -> tuple[Subject, ...]:
    """Return all subjects, in the order in which they are shown."""
    from studio.live.doctor import subjects as package  # noqa: PLC0415 - some need Zenoh

    found = [cast("Subject", one) for one in modules_of(package)]
    return tuple(sorted(found, key=lambda one: _SUBJECTS.index(one.SUBJECT)))


class Concluded(NamedTuple):
    """What one subject concluded: its first findings, how many more, and what it looked at."""

    findings: tuple[Finding, ...]
    more: int
    view: SubjectView


def examine(seen: Seen) -> Examination:
    """Conclude all of the facts; pure, and for a thread where the graph is large."""
    return examination_of(concluded(seen, _SUBJECTS))


def concluded(seen: Seen, names: Collection[SubjectName]) -> dict[SubjectName, Concluded]:
    """Return what some subjects conclude of the facts."""
    found: dict[SubjectName, Concluded] = {}
    for subject in subjects():
        if subject.SUBJECT in names:
            findings, more = _bounded(subject.findings(seen))
            is_well = not any(one.level != "note" for one in findings)
            view = _view(subject, seen, is_well=is_well)
            found[subject.SUBJECT] = Concluded(tuple(findings), more, view)
    return found


def examination_of(found: Mapping[SubjectName, Concluded]) -> Examination:
    """Put together what all subjects concluded."""
    in_order = [found[one] for one in _SUBJECTS]
    findings = [finding for one in in_order for finding in one.findings]
    findings.sort(key=lambda one: _LEVELS.index(one.level))
    more = sum(one.more for one in in_order) + max(0, len(findings) - FINDINGS_MAX)
    views = tuple(one.view for one in in_order)
    return Examination(tuple(findings[:FINDINGS_MAX]), more, views)


def _bounded(findings: Iterator[Finding]) -> tuple[list[Finding], int]:
    """Return the first findings of each code, shortened, and how many are left out."""
    counts: dict[str, int] = {}
    kept: list[Finding] = []
    left_out = 0
    for one in findings:
        counts[one.code] = counts.get(one.code, 0) + 1
        if counts[one.code] <= OF_ONE_CODE_MAX:
            kept.append(_shortened(one))
        else:
            left_out += 1
    return kept, left_out


def _shortened(finding: Finding) -> Finding:
    about = [one for one in finding.about if len(one.name) <= _LINE_MAX]
    return finding.model_copy(
        update={
            "sentence": short(finding.sentence, _SENTENCE_MAX),
            "line": short(finding.line, _LINE_MAX),
            "about": tuple(about[:_LINES_MAX]),
            "evidence": tuple(short(one, _LINE_MAX) for one in finding.evidence[:_LINES_MAX]),
        }
    )


def _view(subject: Subject, seen: Seen, *, is_well: bool) -> SubjectView:
    looked = subject.looked_at(seen)
    if looked is None:
        return SubjectView(
            subject=subject.SUBJECT,
            state="not_examined" if is_well else "found",
            count=0,
            detail="",
        )
    return SubjectView(
        subject=subject.SUBJECT,
        state="well" if is_well else "found",
        count=looked.count,
        detail=short(looked.detail, _LINE_MAX),
    )
