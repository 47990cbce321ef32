"""Why a run stops: faults raised anywhere in the evaluator, turned into one Problem at its edge."""

from __future__ import annotations

from difflib import get_close_matches
from itertools import islice
from typing import TYPE_CHECKING, Final

from studio.problems import Fix, Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.problems import MacroCall


_NAMES_MAX: Final = 2_000
_SENTENCE_LIMIT: Final = 480
"""Characters; names and texts of hostile files may be as long as the file."""


class Fault(Exception):  # noqa: N818 - a fault of the description, not of the studio
    """The description cannot be expanded; one sentence with what to do.

    The place is filled in once, by the first caller that knows it.

    Attributes:
        code: Stable, kebab-case, the `code` of the Problem.
        unreadable: A file is missing or cannot be opened; an optional include may go on.
        package: A package that was not found; the fix is to choose its folder.
    """

    def __init__(
        self, code: str, sentence: str, *, unreadable: bool = False, package: str = ""
    ) -> None:
        super().__init__(sentence)
        self.code, self.sentence = code, sentence
        self.unreadable, self.package = unreadable, package
        self.misnamed: tuple[str, str] | None = None
        """The unknown name, and the one that was probably meant."""
        self.place: Place | None = None
        self.include_chain: tuple[Place, ...] = ()
        self.macro_stack: tuple[MacroCall, ...] = ()


class Refusal(Fault):
    """The description asks for something unsafe or over budget: final, no fallback is tried."""


class Unsupported(Exception):  # noqa: N818 - never leaves the room
    """Our evaluator does not know this construct; the stock library may."""


def misnamed(code: str, sentence: str, name: str, known: Iterable[str], otherwise: str) -> Fault:
    """Return the fault of an unknown name: its sentence ends with the one probably meant.

    Args:
        code: As of a `Fault`.
        sentence: What is wrong, up to its colon.
        name: As it is written.
        known: The existing names.
        otherwise: What to do when none of them is similar.
    """
    meant = near(name, known)
    fault = Fault(
        code, f'{sentence}: did you mean "{meant}"?' if meant else f"{sentence}: {otherwise}"
    )
    fault.misnamed = (name, meant) if meant else None
    return fault


def near(name: str, known: Iterable[str]) -> str:
    """Return the known name that is nearly this one; empty when none is."""
    found = get_close_matches(name, islice(known, _NAMES_MAX), n=1, cutoff=0.7)
    return found[0] if found else ""


def shorten(text: str, limit: int = 120) -> str:
    """Return a text for a sentence: on one line, cut when long."""
    line = " ".join(text.encode("utf-8", "replace").decode().split())
    return line if len(line) <= limit else line[: limit - 3] + "..."


def problem_of(fault: Fault, entry: str) -> Problem:
    """Return a fault as the studio reports it."""
    fix = None
    if fault.package:
        fix = Fix("Choose its folder", "choose_package", fault.package)
    return Problem(
        Severity.ERROR,
        fault.code,
        shorten(fault.sentence, _SENTENCE_LIMIT),
        fault.place or Place(entry),
        fault.include_chain,
        fault.macro_stack,
        fix,
    )
