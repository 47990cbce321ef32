"""Evaluate the texts of one run: expressions, substitutions, lazy bindings, and who read what."""

from __future__ import annotations

import os
import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final, cast

from studio.description.evaluator.graph import Argument, Record, Role, YamlReads
from studio.description.evaluator.substitution import find_package, substitute
from studio.description.evaluator.yaml_values import Reader, YamlMapping, wrap
from studio.description.expressions.bounds import Budget, Limits, is_lasting
from studio.description.expressions.expressions import Expression, compile_expression, helpers_of
from studio.description.expressions.guards import SIZE_LIMIT, text_of
from studio.description.expressions.symbols import make_symbols, pure_names
from studio.description.faults import Fault, Refusal, misnamed, shorten
from studio.description.syntax.templates import Cut, segments_of
from studio.problems import Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Iterator

    from studio.description.evaluator.graph import (
        Cell,
        Consumer,
        Input,
        NameReplay,
        Scope,
        Sink,
        YamlValue,
    )
    from studio.description.evaluator.source_store import SourceStore
    from studio.description.syntax.source_tree import SourceElement
    from studio.description.values import ReadPolicy

_PURE_LIMITS: Final = Limits(seconds=0.5)
"""Of one expression in a YAML file."""
_TEXT_FOR_NUMBER: Final = re.compile(
    r"multiply sequence|(unsupported operand|not supported between|bad operand).*'str'"
    r"|must be real number, not str|can only concatenate str|must be str, not"
)
"""Python's error about arithmetic with a text."""
_ARG_COMPARED: Final = re.compile(r"""['"]?\$\(arg\s+(\w+)\)['"]?\s*[=!]=\s*['"]([^'"]*)['"]""")
_STRUCTURE: Final = Role.STRUCTURE
_PLAIN: Final = frozenset({int, float, str, bool, type(None)})
_LONG: Final = 1_000
"""Characters; shorter texts are bounded by their number."""
_NOT_XML: Final = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
WARNINGS_LIMIT: Final = 1_000
_MESSAGE_LIMIT: Final = 2_000
"""Characters."""
_SEVERITIES: Final = {
    "message": Severity.INFO,
    "deprecated": Severity.INFO,
    "warning": Severity.WARNING,
    "error": Severity.WARNING,
}


def pure_value(text: str) -> Any:  # noqa: ANN401
    """Return an expression of a YAML file: no names but mathematics and builtins.

    Raises:
        Fault: It cannot be evaluated.
    """
    code = compile_expression(text).code
    try:
        return eval(code, pure_names(Budget(_PURE_LIMITS).steps))
    except Fault:
        raise
    except Exception as error:  # noqa: BLE001 - whatever the expression does
        raise failed(text, error) from None


def literal_value(value: Any) -> Any:  # noqa: ANN401
    """Type a text as xacro does when it binds one: int, float, bool, quoted text, else as it is."""
    if not isinstance(value, str):
        return value
    if len(value) >= 2 and value[0] == value[-1] == "'":
        return value[1:-1]
    if "_" in value:  # Python would read 1_000 as a number
        return value
    for read in (int, float):
        try:
            return read(value)
        except ValueError:
            continue
    return {"true": True, "True": True, "false": False, "False": False}.get(value, value)


def truth_of(value: Any, condition: str | None) -> bool:  # noqa: ANN401
    """Return the value of a condition, by xacro's rules.

    Raises:
        Fault: A text that is neither true, false nor a whole number.
    """
    if not isinstance(value, str):
        return bool(value)
    if value in {"true", "True"}:
        return True
    if value in {"false", "False"}:
        return False
    try:
        return bool(int(value))
    except ValueError:
        sentence = f'"{condition}" came to "{value}", which is neither true nor false.'
        raise Fault("not-a-condition", sentence) from None


def failed(text: str, error: Exception) -> Fault:
    """Return the fault of an expression's exception."""
    reason = str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error)
    if isinstance(error, KeyError):
        reason = f"there is no key {error}"
    if isinstance(error, TypeError) and _TEXT_FOR_NUMBER.search(reason):
        reason = "a text stands where a number is needed; is a value in it empty or no number?"
    spoken = (reason or type(error).__name__).rstrip(".")
    return Fault(
        "bad-expression",
        f'"{shorten(text)}" cannot be evaluated: {spoken}{"" if spoken.endswith("?") else "."}',
    )


def out_of_bounds(error: BaseException) -> Refusal:
    """Return the refusal of a RecursionError or MemoryError."""
    if isinstance(error, MemoryError):
        return Refusal("value-too-large", "An expression needs too much memory.")
    return Refusal("nested-too-deep", "Properties or expressions are nested too deeply.")


class Texts:
    """Evaluates texts for one run. `at` is the element being worked on, for places of faults."""

    def __init__(self, store: SourceStore, policy: ReadPolicy, budget: Budget) -> None:
        self.store, self.policy, self.budget = store, policy, budget
        self.environment = policy.environment
        self.arguments: dict[str, Argument] = {}
        self.files: list[str] = []
        """Files being processed, the innermost last, as named: relative paths start there."""
        self.warnings: dict[Problem, None] = {}
        self.yaml: dict[str, YamlReads] = {}
        self.at: SourceElement | None = None
        self.symbols = make_symbols(self)
        self.helpers = helpers_of(budget.steps)
        self.replay: NameReplay | None = None
        self.evaluations = 0
        """How many have ended; numbers the records."""
        self.asked_at: dict[str, float] = {}
        """By file, how many evaluations had ended when it was read first."""
        self.is_pure = True
        """No expression changes a value or uses one up, and no half of a run was given up."""
        self._now = Record("", cast("Scope", None), "", Role.NOTHING, None)
        self._resolving: list[str] = []

    # What the elements ask for

    def value(self, text: str, scope: Scope) -> Any:  # noqa: ANN401
        """Return a text's typed value; its reads are noted.

        Raises:
            Fault: It cannot be evaluated.
        """
        if "$" not in text:
            return text
        self.budget.evaluation()
        segments = segments_of(text)
        if len(segments) == 1:
            return self._segment(*segments[0], scope)
        pieces = [
            piece if cut is Cut.TEXT else text_of(self._segment(cut, piece, scope))
            for cut, piece in segments
        ]
        joined = "".join(pieces)
        if len(joined) > SIZE_LIMIT:
            raise Refusal("value-too-large", "A text grows too large.")
        if len(joined) > _LONG:
            self.budget.text(len(joined))
        return joined

    def evaluated(
        self, text: str, scope: Scope, sink: Sink, consumer: Consumer | None = None
    ) -> Record:
        """Return a text with its value and what it read."""
        record = Record(text, scope, self.files[-1], sink, consumer)
        outer, self._now = self._now, record
        record.value = self.value(text, scope)
        self._now = outer
        self.ended(record)
        if "$(arg" in text:
            self._note_comparisons(text)
        return record

    def consumed(self, text: str, scope: Scope, consumer: Consumer, role: Role = _STRUCTURE) -> Any:  # noqa: ANN401
        """Return a text's value where it is neither output nor bound to a name."""
        return text if "$" not in text else self.evaluated(text, scope, role, consumer).value

    def echoed(self, text: str, scope: Scope) -> Any:  # noqa: ANN401
        """Return a text's value where it is not used: xacro evaluates more texts than it needs."""
        if "$" not in text:
            return text
        record = Record(text, scope, self.files[-1], Role.NOTHING, None)
        outer, self._now = self._now, record
        record.value = self.value(text, scope)
        self._now = outer
        self.ended(record)
        return record.value

    def forwarded(self, name: str, scope: Scope, cell: Cell) -> Record:
        """Return the value of a name, on its way to the parameter that it is forwarded to."""
        record = Record(name, scope, self.files[-1], cell, None)
        record.forwards = True
        outer, self._now = self._now, record
        record.value = scope.value_of(name)
        self._now = outer
        self.ended(record)
        return record

    def bind(self, cell: Cell, record: Record, *, at_once: bool = True) -> None:
        """Give a cell the value of its evaluated text."""
        cell.record = record
        cell.value = literal_value(record.value)
        if type(cell.value) not in _PLAIN and not is_lasting(cell.value):
            self.is_pure = False  # whatever reads it uses it up
        if not at_once:
            cell.pending = None

    def ended(self, record: Record) -> None:
        """An evaluation came to its end: it gets its number, and those it read know it."""
        self.evaluations += 1
        record.order = self.evaluations
        for one in record.reads:
            one.readers.append(record)

    def mark(self) -> tuple[Record, SourceElement | None, int]:
        """Return the state to go `back_to` when an optional include fails half-way."""
        return self._now, self.at, len(self._resolving)

    def back_to(self, marked: tuple[Record, SourceElement | None, int]) -> None:
        """Undo what a fault left behind; files stay, as xacro leaves them."""
        self.is_pure = False
        self._now, self.at = marked[:2]
        del self._resolving[marked[2] :]

    def note(self, one: Input) -> None:
        """Note that the running text read a value of a YAML file."""
        self._now.reads.append(cast("YamlValue", one))

    @contextmanager
    def replayed(self, replay: NameReplay) -> Generator[None]:
        """Evaluate texts once more, each behind `replay_from`."""
        before = self._now, self.files, self.at
        self.at, self.replay = None, replay
        try:
            yield
        finally:
            self._now, self.files, self.at = before
            self.replay = None

    def replay_from(self, file: str, noted_at: Record) -> None:
        """The text replayed next stands in a file; what it reads is noted at a record."""
        self._now, self.files = noted_at, [file]

    def warn(self, code: str, sentence: str, severity: Severity = Severity.WARNING) -> None:
        """Note a warning at the element being worked on, once."""
        self._note_effect(sentence)
        if len(self.warnings) >= WARNINGS_LIMIT:
            return
        place = self.at.place if self.at else None
        self.warnings[Problem(severity, code, sentence, place)] = None

    # What scopes ask for

    def read(self, name: str, cell: Cell, scope: Scope) -> Any:  # noqa: ANN401
        """Return the value of a cell, evaluated in its own scope at the first read."""
        if cell.pending is not None:
            self._resolve(name, cell, scope)
        self._now.reads.append(cell)
        return cell.value

    def undefined(self, name: str, scope: Scope) -> Fault:
        """Return the fault of a name that no scope has."""
        if name in self.arguments:
            return Fault("undefined-property", f'"{name}" is an arg: read it with $(arg {name}).')
        if scope.find(f"**{name}"):
            return Fault(
                "undefined-property", f'"{name}" names a block: give its property a value.'
            )
        otherwise = f'define it with <xacro:property name="{name}" value="..."/>.'
        sentence = f'"{name}" is not defined here'
        known = (one for one in scope.all_names() if not one.startswith("*"))
        return misnamed("undefined-property", sentence, name, known, otherwise)

    def _resolve(self, name: str, cell: Cell, scope: Scope) -> None:
        if cell.resolving:
            chain = " -> ".join([*self._resolving, name])
            raise Fault("circular-property", f"Properties define each other in a circle: {chain}.")
        cell.resolving = True
        self._resolving.append(name)
        outer_at, self.at = self.at, cell.at or self.at
        trigger = self._now
        try:
            record = self.evaluated(cell.pending or "", scope, cell)
        except Fault as fault:
            self.locate(fault)
            fault.unreadable = False  # an optional include does not excuse what it reads lazily
            raise
        record.trigger = trigger
        self.bind(cell, record, at_once=False)
        cell.resolving, self.at = False, outer_at
        self._resolving.pop()

    def locate(self, fault: Fault) -> None:
        """Give a fault its place, unless it has one from further inside."""
        if fault.place is None and self.at is not None:
            fault.place = self.at.place

    # What symbols and substitutions ask for

    def argument(self, name: str) -> str:
        """Return the value of an arg, noted as read.

        Raises:
            Fault: Neither given nor declared.
        """
        found = self.arguments.get(name)
        if found is None:
            otherwise = f"declare it with <xacro:arg> or pass {name}:=value."
            sentence = f'The arg "{name}" is not given'
            raise misnamed("undefined-argument", sentence, name, self.arguments, otherwise)
        self._now.reads.append(found)
        return found.value

    def find_package(self, name: str) -> str:
        """Return the folder of a package, seen from the file being processed."""
        return find_package(self.policy.packages, name, self.files[-1])

    def absolute(self, path: str) -> str:
        """Return a path as seen from the file being processed."""
        if os.path.isabs(path):  # noqa: PTH117 - texts, as xacro joins them
            return path
        return os.path.join(os.path.dirname(self.files[-1]), path)  # noqa: PTH118, PTH120

    def dotify(self, items: dict[Any, Any]) -> Any:  # noqa: ANN401
        """Return a mapping whose keys are read with dots, too."""
        return YamlMapping(items, None, ())

    def load_yaml(self, path: str) -> Any:  # noqa: ANN401
        """Return the values of a YAML file, every read of them noted."""
        real, data, values = self.store.yaml(self.absolute(path), pure_value)
        if real not in self.yaml:
            self.asked_for(real)
        reads = self.yaml.setdefault(real, YamlReads(real, data))
        self._now.reads.append(reads)
        if self.at is not None and self.at not in reads.loaded_by:
            reads.loaded_by.append(self.at)
        return wrap(values, Reader(reads, self.note), ())

    def asked_for(self, file: str) -> None:
        """A file was read; note when that was for the first time."""
        if self.replay is not None:
            self.replay.refuse(f"{file} was not read before")
        self.asked_at.setdefault(file, self.evaluations)

    def log(self, severity: str, text: str) -> None:
        """A message of the description, or about a name that it uses."""
        if text:
            message = shorten(text, _MESSAGE_LIMIT)
            self.warn(f"xacro-{severity}", message, _SEVERITIES[severity])

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        """Return the items of a loop, each counted."""
        return self.budget.steps(items)

    # Segments

    def _segment(self, cut: Cut, text: str, scope: Scope) -> Any:  # noqa: ANN401
        if cut is Cut.EXPRESSION:
            return self._expression(self._inner(text, scope) if "$" in text else text, scope)
        if cut is Cut.SUBSTITUTION:
            return self._substitution(text, scope)
        return text

    def _inner(self, text: str, scope: Scope) -> str:
        """Return the text of an expression that is put together first."""
        inner = text_of(self.value(text, scope))
        if compile_expression(inner).compared:
            self._note_effect("what is compared depends on a value")
        return inner

    def _note_effect(self, reason: str) -> None:
        """Note that the running text has an effect besides its value."""
        if self.replay is not None:
            self.replay.refuse(reason)
        self._now.is_noisy = True

    def _expression(self, text: str, scope: Scope) -> Any:  # noqa: ANN401
        expression = compile_expression(text)
        if expression.name is not None:
            return self._counted(scope.value_of(expression.name))
        if not expression.is_pure:
            self._note_effect("an expression changes what it reads")
            self.is_pure = False
        try:
            value = eval(expression.code, scope.names)
        except Fault:
            raise
        except (RecursionError, MemoryError) as error:
            raise out_of_bounds(error) from None
        except Exception as error:  # noqa: BLE001 - whatever the expression does
            raise failed(text, error) from None
        if expression.compared and self.replay is None:
            self._note_compared(expression, scope)
        return self._counted(value)

    def _counted(self, value: Any) -> Any:  # noqa: ANN401
        """Return the value; a text can be written as XML, and is counted when it is long."""
        if type(value) is str:
            if len(value) > _LONG:
                self.budget.text(len(value))
            if not value.isprintable() and _NOT_XML.search(value):
                raise Fault("not-xml-text", "It makes a character that XML cannot hold.")
        return value

    def _substitution(self, text: str, scope: Scope) -> str:
        command = text_of(self.value(text, scope)) if "$" in text else text
        if command == "cwd":
            return os.getcwd()  # noqa: PTH109 - as xacro writes it
        try:
            return self._counted(substitute(command, self))
        except Fault:
            raise
        except (RecursionError, MemoryError) as error:
            raise out_of_bounds(error) from None
        except Exception as error:  # noqa: BLE001 - $(eval) may raise anything
            raise failed(command, error) from None

    # Notes

    def _note_comparisons(self, text: str) -> None:
        if "=" not in text:
            return
        for name, compared in _ARG_COMPARED.findall(text):
            if name in self.arguments:
                argument = self.arguments[name]
                (argument.binding or argument).compared[compared] = None

    def _note_compared(self, expression: Expression, scope: Scope) -> None:
        for name, text in expression.compared:
            found = scope.find(name)
            if found is not None and found[0].binding is not None:
                found[0].binding.compared[text] = None
