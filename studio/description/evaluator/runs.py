"""Results of runs: of a good run its record and its texts, of broken texts what can be read.

`sites` builds sites from a record, `origins` and `language` answer questions from a good run.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.source_store import RecoveringStore, SourceStore
from studio.description.faults import Fault, Unsupported, shorten
from studio.description.syntax.recovery import recover
from studio.description.syntax.source_tree import SourceError
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Mapping, Set

    from studio.description.evaluator.graph import Binding, YamlReads
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.syntax.source_tree import SourceElement, SourceTree
    from studio.description.syntax.xml_faults import XmlFault
    from studio.description.values import ReadPolicy
    from studio.problems import Place

_SENTENCE_LIMIT: Final = 480


@dataclass(slots=True)
class RunRecord:
    """One finished run. `trees` and `yaml` are keyed by absolute path, symlinks resolved."""

    entry: str
    trees: Mapping[str, SourceTree]
    files: tuple[str, ...]
    """Every file read, in order, the entry first, YAML included."""
    includes: tuple[tuple[str, str], ...]
    """(includer, included) pairs, in order, once each."""
    bindings: tuple[Binding, ...]
    """In the order in which the run met them."""
    yaml: Mapping[str, YamlReads]
    part_keys: Mapping[SourceElement, tuple[str, ...]]
    """The parts that each source element came out in; an element in no part is missing."""
    arguments: Mapping[str, str]
    """Values of all args as strings: given ones and defaults."""
    warnings: tuple[Problem, ...]


@dataclass(frozen=True, slots=True)
class GoodRun:
    """What a run read and what came out of it; the session's texts may have changed since."""

    root: OutputElement
    record: RunRecord
    evaluator: str
    """As in `Expansion`."""
    entry: str
    arguments: Mapping[str, str]
    policy: ReadPolicy
    store: SourceStore
    """The texts as they were, for another run of them."""
    sites: Set[str]
    """Ids of the texts that can be edited."""


@dataclass(frozen=True, slots=True)
class RecoveredRun:
    """What can be read of broken texts; without a `root` there is no link, perhaps for `fault`."""

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
    """Return what is wrong with the XML of a broken text; empty when it cannot be read at all."""
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
