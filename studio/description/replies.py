"""From a question to the function that answers it from the last good run."""

from __future__ import annotations

from typing import TYPE_CHECKING, assert_never

from studio.description.checks.check_values import CheckQuery
from studio.description.faults import Fault
from studio.description.language.questions import (
    CompletionQuery,
    LookUpQuery,
    OutlineQuery,
    ReferencesQuery,
    RenamingQuery,
)
from studio.description.origins.effects import site_effects
from studio.description.origins.origin_values import PartOriginQuery, SiteEffectsQuery
from studio.description.origins.provenance import part_origin
from studio.description.values import NoReply

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.description.origins.good_run import GoodRun
    from studio.description.queries import Query, Reply

NOT_OPEN = "No robot is open in this worker: open it again."


def reply_to(query: Query, run: GoodRun | None) -> Reply:
    """Answer a question; one that has no answer, or fails, is told so in a sentence."""
    if run is None:
        return NoReply("The description has not been expanded yet: mend its problems first.")
    return guarded(lambda: _reply(query, run))


def guarded(answer: Callable[[], Reply]) -> Reply:
    """The answer, or what hindered it in a sentence."""
    try:
        return answer()
    except Fault as fault:
        return NoReply(fault.sentence)
    except Exception as error:  # noqa: BLE001 - a question may not cost the process its robot
        return NoReply(f"The question could not be answered: {type(error).__name__}: {error}")


def _reply(query: Query, run: GoodRun) -> Reply:
    match query:
        case PartOriginQuery(part=part):
            return part_origin(run, part)
        case SiteEffectsQuery(site=site):
            return site_effects(run, site)
        case (
            OutlineQuery() | LookUpQuery() | ReferencesQuery() | CompletionQuery() | RenamingQuery()
        ):
            raise TypeError("the language desk answers what is asked about texts")
        case CheckQuery():
            raise TypeError("the session answers what is asked about all texts")
        case _:
            assert_never(query)
