"""Figures and how they are printed: medians and p95, ratios, and what was asked of them."""

from __future__ import annotations

import os
import statistics
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Generator


@dataclass
class Timings:
    """Milliseconds of one thing, run after run."""

    name: str
    values_ms: list[float] = field(default_factory=list[float])

    @contextmanager
    def measure(self) -> Generator[None]:
        """Time the block."""
        begin_s = time.perf_counter()
        yield
        self.values_ms.append((time.perf_counter() - begin_s) * 1000)

    @property
    def median_ms(self) -> float:
        """The middle value."""
        return statistics.median(self.values_ms)

    @property
    def p95_ms(self) -> float:
        """The value that one in twenty passes."""
        ordered = sorted(self.values_ms)
        return ordered[min(len(ordered) - 1, round(0.95 * (len(ordered) - 1)))]


@dataclass(frozen=True)
class Verdict:
    """One asked measure and what came of it."""

    what: str
    asked: str
    got: str
    met: bool

    def __str__(self) -> str:
        """One line of the table."""
        word = "met" if self.met else "MISSED"
        return f"  {word:<8}{self.what:<56}{self.asked:>18}{self.got:>16}"


VERDICTS: list[Verdict] = []
"""Of this run, in the order in which they were found."""
NOTED: dict[str, str] = {}
"""Figures of this run that nothing is asked of."""


def note(what: str, figure: str) -> None:
    """Say a figure of which nothing is asked, and keep it beside the verdicts."""
    NOTED[what] = figure
    say(f"  noted   {what:<74}{figure:>16}")


def judge(what: str, got: float, *, at_most: float, unit: str = "ms") -> None:
    """Say whether a figure is small enough, and keep it for the table at the end."""
    _keep(Verdict(what, f"<= {at_most:.4g} {unit}", f"{got:.3g} {unit}", got <= at_most))


def judge_ratio(what: str, got: float, *, at_least: float) -> None:
    """Say whether something is so many times better than its peer, and keep it for the table."""
    _keep(Verdict(what, f">= {at_least:g} times", f"{got:.3g} times", got >= at_least))


def judge_that(what: str, *, holds: bool) -> None:
    """Say whether something holds, and keep it for the table."""
    _keep(Verdict(what, "yes", "yes" if holds else "no", holds))


def _keep(verdict: Verdict) -> None:
    VERDICTS.append(verdict)
    say(str(verdict))


def say_verdicts() -> None:
    """The table of everything that was asked."""
    if VERDICTS:
        say("\n[asked]")
        for verdict in VERDICTS:
            say(str(verdict))
        say(f"{sum(one.met for one in VERDICTS)} of {len(VERDICTS)} met")


def say(line: str = "") -> None:
    """Write a line at once."""
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def say_machine() -> None:
    """What the figures were measured on."""
    load = f", load {os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else ""
    say(f"{os.cpu_count()} cores{load}, Python {sys.version.split()[0]}; compare ratios")


def say_beside(title: str, ours: Timings, *peers: Timings) -> None:
    """One line for ours and one for each peer with how many times ours it takes."""
    say(f"{title}")
    say(f"  {ours.name:<44}{_figures(ours)}")
    for peer in peers:
        ratio = peer.median_ms / ours.median_ms if ours.median_ms else float("inf")
        say(f"  {peer.name:<44}{_figures(peer)}   {ratio:.1f} x ours")


def _figures(timings: Timings) -> str:
    runs = len(timings.values_ms)
    return f"median {timings.median_ms:9.3f} ms   p95 {timings.p95_ms:9.3f} ms   n {runs}"
