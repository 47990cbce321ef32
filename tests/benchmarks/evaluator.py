"""Our evaluator alone, in this process: the full run and the edit of one property, beside xacro.

An edit is what the worker does for one `EditRequest`: the text, the patch or the run, and the parts
and sites that changed. Every numeric site is turned once, a value near its own.
"""

from __future__ import annotations

import gc
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from studio.description.editing.sources import Sources
from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.source_store import SourceStore
from studio.description.session import open_session
from studio.description.values import EditRequest, Expansion, OpenRequest
from studio.packages.roots import ServedRoots
from tests.benchmarks.report import Timings, judge, judge_ratio, say, say_beside
from tests.benchmarks.robots import MeasuredRobot, corpus_robots, rover
from tests.benchmarks.stock import Stock
from tests.support.descriptions import policy_for

if TYPE_CHECKING:
    from studio.description.values import Edit, Site

EDITS = 120
FULL_RUNS = 20
STOCK_RUNS = 7
_ASKED = frozenset({"UR10e", "PR2"})


def run() -> None:
    """Measure the rover and, with a corpus, UR10e and PR2."""
    for robot in (rover(), *corpus_robots()):
        with tempfile.TemporaryDirectory() as folder:
            _measure(robot, Path(folder))


def _measure(robot: MeasuredRobot, scratch: Path) -> None:
    full, edits = Timings("full run with tracking"), Timings("one site edited")
    command, stock = Timings("the xacro command"), Timings("stock xacro in-process, warm")
    peer, session, whole = Stock(robot, scratch), EditSession(robot), FullRun(robot)
    peer.in_process()
    gc.collect()
    gc.freeze()  # neither side's collections look at what the other one holds
    for _ in range(STOCK_RUNS):
        with command.measure():
            peer.by_command()
        with stock.measure():
            peer.in_process()
        gc.collect()
        gc.disable()  # the worker collects between requests
        for _ in range(FULL_RUNS // STOCK_RUNS + 1):
            with full.measure():
                whole.run()
        session.edit_some(EDITS // STOCK_RUNS + 1, edits)
        gc.enable()
    gc.unfreeze()
    say_beside(f"{robot.name}: the whole file", full, stock, command)
    say_beside(f"{robot.name}: one of {len(session.numeric)} sites", edits, stock, command)
    say(f"  sites that could not be edited: {session.refused}")
    if robot.name in _ASKED:
        name = robot.name
        judge_ratio(f"{name}: full run against stock", stock.median_ms / full.median_ms, at_least=8)
        judge(f"{name}: edit p95, command / 200", edits.p95_ms, at_most=command.median_ms / 200)
        judge(f"{name}: edit p95, stock / 50", edits.p95_ms, at_most=stock.median_ms / 50)


class FullRun:
    """Runs a file whose texts are parsed already."""

    def __init__(self, robot: MeasuredRobot) -> None:
        self._robot = robot
        self._policy = policy_for(robot.packages or robot.file.parent)
        self._store = SourceStore(ServedRoots(map(Path, self._policy.roots)), {})
        self.run()

    def run(self) -> None:
        """From parsed texts to the output tree."""
        self._store.begin_run()
        Evaluation(self._store, self._policy, self._robot.mappings()).run(str(self._robot.file))


class EditSession:
    """One session, and the engine's own book of where its sites stand."""

    def __init__(self, robot: MeasuredRobot) -> None:
        policy = policy_for(robot.packages or robot.file.parent)
        request = OpenRequest(str(robot.file), robot.mappings(), policy, {})
        session, answer = open_session(request)
        assert session is not None
        assert isinstance(answer, Expansion)
        self._session = session
        self._sources = Sources(Path.read_bytes, Path.resolve)
        self._sources.adopt(answer, 0)
        numeric = [site for site in answer.changed_sites if site.number is not None and site.reads]
        step = max(1, len(numeric) // EDITS)
        self.numeric = numeric[::step]
        self.refused = 0
        self._next = 0

    def edit_some(self, count: int, timings: Timings) -> None:
        """Turn the next sites, each once, and put those back that the robot cannot do without."""
        for _ in range(count):
            site = self.numeric[self._next % len(self.numeric)]
            self._next += 1
            edit = self._sources.edit_site(site.id, _text(site, self._next))
            if not self._run(edit, timings):
                self.refused += 1
                self._take_back()

    def _run(self, edit: Edit, timings: Timings) -> bool:
        version = self._sources.spans.version
        with timings.measure():
            answer = self._session.answer(EditRequest((edit,)))
        if isinstance(answer, Expansion):
            self._sources.adopt(answer, version)
            return True
        timings.values_ms.pop()
        return False

    def _take_back(self) -> None:
        change = self._sources.undo()
        assert change is not None
        answer = self._session.answer(EditRequest(change.edits))
        assert isinstance(answer, Expansion)
        self._sources.adopt(answer, self._sources.spans.version)


def _text(site: Site, number: int) -> str:
    """A value near the written one, never the same twice in a row."""
    value = site.number or 0.1
    return f"{value * (1 + 0.01 * (1 + number % 20)):.5f}"
