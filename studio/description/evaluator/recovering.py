"""A run of texts that are broken, as far as they can be read: for checks, and for a first look."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.source_store import SourceStore
from studio.description.faults import Fault, Unsupported, shorten
from studio.description.syntax.recovery import RECOVERABLE, recover
from studio.description.syntax.source_tree import SourceError
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.syntax.source_tree import SourceTree
    from studio.description.syntax.xml_faults import XmlFault
    from studio.description.values import ReadPolicy
    from studio.problems import Place

_SENTENCE_LIMIT = 480


class RecoveringStore(SourceStore):
    """The texts of another store, of which it reads the broken ones, too."""

    def __init__(self, store: SourceStore) -> None:
        super().__init__(store._roots, {})
        self._data, self._trees = dict(store._data), dict(store._trees)
        self.faults: dict[str, tuple[XmlFault, ...]] = {}
        """What is wrong, by file."""

    def tree(self, path: str) -> SourceTree:
        """As `SourceStore.tree`, and never a fault because the XML is broken."""
        try:
            return super().tree(path)
        except Fault as fault:
            if fault.code not in RECOVERABLE:
                raise
            return self._recovered(path, fault)

    def _recovered(self, path: str, fault: Fault) -> SourceTree:
        real, data = self.read(path)
        try:
            recovered = recover(real, data)
        except SourceError:
            raise fault from None
        self.faults[real] = recovered.faults
        self._trees[real] = recovered.tree
        return recovered.tree


@dataclass(frozen=True, slots=True)
class RecoveredRun:
    """What broken texts come to; without a `root` it has no link, for `fault` perhaps."""

    evaluation: Evaluation
    store: RecoveringStore
    root: OutputElement | None
    problems: tuple[Problem, ...]
    """What is wrong with the XML of all files, the first one first."""
    fault: Fault | None = None


def recovered_run(
    store: SourceStore, policy: ReadPolicy, arguments: Mapping[str, str], entry: str
) -> RecoveredRun:
    """Run an entry file and whatever of the texts can be read; never raises for what they hold."""
    reading = RecoveringStore(store)
    evaluation = Evaluation(reading, policy, arguments)
    root, fault = None, None
    try:
        root = evaluation.run(entry)
        if root.tag != "robot" or not any(one.tag == "link" for one in root.elements()):
            root = None
    except Fault as met:
        fault = met
    except (Unsupported, MemoryError):
        pass
    problems = [
        problem
        for file, faults in reading.faults.items()
        for problem in xml_problems(faults, evaluation.chain_to(file))
    ]
    return RecoveredRun(evaluation, reading, root, tuple(problems), fault)


def problems_of_text(path: str, data: bytes, chain: tuple[Place, ...]) -> tuple[Problem, ...]:
    """What is wrong with the XML of one broken text; empty when it cannot be read at all."""
    try:
        return xml_problems(recover(path, data).faults, chain)
    except SourceError:
        return ()


def xml_problems(faults: tuple[XmlFault, ...], chain: tuple[Place, ...]) -> tuple[Problem, ...]:
    """Faults of one file as the studio reports them."""
    return tuple(
        Problem(
            Severity.ERROR,
            fault.code,
            shorten(fault.sentence, _SENTENCE_LIMIT),
            fault.place,
            chain,
            fix=fault.fix,
        )
        for fault in faults
    )
