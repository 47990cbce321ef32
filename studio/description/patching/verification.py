"""A full run compared with what was told before, when nothing but patches came between."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import TYPE_CHECKING

from studio.description.values import PATCH_DIFFERED, Expansion, Failure
from studio.problems import Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterator

_log = logging.getLogger(__name__)


def verified(
    answer: Expansion | Failure, told: Expansion | None, entry: str
) -> Expansion | Failure:
    """A full run's answer: news only when it corrects anything, which is told and logged.

    One that only proves the patches right is marked as they are.
    """
    if isinstance(answer, Failure):
        return _unproven(answer, entry)
    found = list(_corrections(answer, told))
    if not found:
        return replace(answer, is_patch=True)
    what = f"{len(found)} of the shown values, the first {found[0]}"
    sentence = f"A quick edit was not what a full run gives; corrected: {what}. Tell us of it."
    _log.error("%s: %s", entry, sentence)
    problem = Problem(Severity.WARNING, PATCH_DIFFERED, sentence, Place(entry))
    return replace(answer, warnings=(*answer.warnings, problem))


def _unproven(failure: Failure, entry: str) -> Failure:
    """A failure that patches have hidden: the robot that is shown is none of a full run."""
    sentence = "A quick edit hid this; the robot that is shown is of that edit. Tell us of it."
    _log.error("%s: %s: %s", entry, sentence, failure.problem.sentence)
    problem = replace(failure.problem, sentence=f"{failure.problem.sentence} {sentence}")
    return replace(failure, problem=problem)


def _corrections(answer: Expansion, told: Expansion | None) -> Iterator[str]:
    """What a full run says otherwise, each by its name."""
    yield from (part.key for part in answer.changed_parts)
    yield from (site.id for site in answer.changed_sites)
    if answer.part_order is not None:
        yield "the order of parts"
    if answer.site_order is not None:
        yield "the order of texts"
    if told is None:
        return
    for name in ("robot_name", "root_attributes", "files", "include_tree", "warnings"):
        if getattr(answer, name) != getattr(told, name):
            yield name
