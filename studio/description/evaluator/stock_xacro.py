# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false
# pyright: reportPrivateUsage=false
"""The door to stock xacro, always behind our guard: for exports, and where our evaluator cannot.

Both of its evals see only checked expressions, its open is the root-checked one, `$(find)` knows
the packages, `$(env)` the given environment. The library keeps its state in module globals, so the
guard is put on for one run and taken off after it; a process runs one at a time.
"""

from __future__ import annotations

import errno
import io
import os
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast
from unittest.mock import patch
from xml.parsers.expat import ExpatError

import xacro
from xacro import substitution_args

from studio.description.evaluator.evaluation import Evaluation, deep_recursion
from studio.description.evaluator.source_store import SourceStore
from studio.description.evaluator.substitution import evaluate, find_package, variable
from studio.description.expressions.bounds import Budget, Limits, made, too_large
from studio.description.expressions.expressions import compile_expression, helpers_of
from studio.description.expressions.guards import METHODS, check_printable
from studio.description.expressions.symbols import guarded_functions
from studio.description.faults import Fault, Refusal, Unsupported, problem_of
from studio.description.syntax.params import PARAMS_LIMIT, parameter
from studio.description.syntax.source_tree import SourceError, parse_source
from studio.description.syntax.yaml_reading import check_aliases
from studio.errors import ExpansionError, RefusedError
from studio.packages.roots import ServedRoots
from studio.problems import Place, Problem, Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
    from xml.dom.minidom import Document

    from studio.description.values import ReadPolicy

EXPORT_LIMITS: Final = Limits(seconds=8.0)
"""Stock is about ten times slower than our own evaluator."""
_LEXED_LIMIT: Final = 1_000_000_000
"""Stock copies the rest of a text for each of its pieces."""


def export_urdf(
    file: str,
    arguments: Mapping[str, str],
    policy: ReadPolicy,
    overlay: Mapping[str, bytes] | None = None,
    limits: Limits = EXPORT_LIMITS,
) -> str:
    """Return what the `xacro` command prints for a file, byte for byte; `file` is in its banner.

    Raises:
        ExpansionError: Xacro cannot expand it.
        RefusedError: It asks for something unsafe or over budget.
    """
    store = SourceStore(ServedRoots(map(Path, policy.roots)), overlay or {})
    fault = _fault_of(Evaluation(store, policy, arguments), file)
    if isinstance(fault, Refusal):  # in a tenth of the time that stock would take
        raise RefusedError(problem_of(fault, file))
    try:
        document = _process(file, arguments, _Guard(policy, store, limits))
    except RefusedError:
        raise
    except ExpansionError:
        if fault is None:
            raise
        raise ExpansionError(problem_of(fault, file)) from None
    return document.toprettyxml(indent="  ")


def expand_root(
    file: str, arguments: Mapping[str, str], policy: ReadPolicy, store: SourceStore
) -> str:
    """Return the expanded root element as XML, of a store; raises as `export_urdf`."""
    root = _process(file, arguments, _Guard(policy, store, Limits())).documentElement
    assert root is not None
    return root.toxml()


def _process(file: str, arguments: Mapping[str, str], guard: _Guard) -> Document:
    with _on(guard), deep_recursion():
        try:
            return cast("Document", xacro.process_file(file, mappings=dict(arguments)))
        except (xacro.XacroException, ExpatError, Fault, RuntimeError, MemoryError) as error:
            raise _translated(error, file) from None
        except (OSError, LookupError, TypeError, ValueError, AttributeError) as error:
            raise _translated(error, file) from None


def _fault_of(evaluation: Evaluation, file: str) -> Fault | None:
    """Return why our evaluator stops, with line and advice; None when it does not, or cannot."""
    try:
        evaluation.run(file)
    except Fault as fault:
        return fault
    except Unsupported:
        pass
    return None


def _translated(error: BaseException, file: str) -> ExpansionError:
    """Xacro's error as a Problem; the innermost refusal inside it is final."""
    place = Place(str((xacro.filestack or [file])[-1]))
    for cause in _causes(error):
        if isinstance(cause, _RefusedOpenError):
            return RefusedError(_problem(cause.refusal.code, cause.refusal.sentence, place))
        if isinstance(cause, Refusal):
            return RefusedError(_problem(cause.code, cause.sentence, place))
        if isinstance(cause, RecursionError):
            sentence = "Macros or properties are nested too deeply: one most likely calls itself."
            return RefusedError(_problem("nested-too-deep", sentence, place))
        if isinstance(cause, MemoryError):
            return RefusedError(_problem("value-too-large", "It needs too much memory.", place))
    sentence = " ".join(str(error).split()) or type(error).__name__
    return ExpansionError(_problem("xacro-failed", f"xacro says: {sentence}.", place))


def _causes(error: BaseException | None) -> Iterator[BaseException]:
    while error is not None:
        yield error
        error = getattr(error, "exc", None)


def _problem(code: str, sentence: str, place: Place) -> Problem:
    return Problem(Severity.ERROR, code, sentence, place)


class _RefusedOpenError(OSError):
    """A refused file, as an error that an optional include passes over."""

    def __init__(self, refusal: Refusal, path: str) -> None:
        super().__init__(errno.EACCES, refusal.sentence, path)
        self.refusal = refusal


class _Guard:
    """Replaces functions of xacro for one run; also the context of `$(...)`."""

    def __init__(self, policy: ReadPolicy, store: SourceStore, limits: Limits) -> None:
        self._policy, self._store = policy, store
        self._budget = Budget(limits)
        self._eval_text: Callable[[Any, Any], Any] = xacro.eval_text
        self._eval_all: Callable[[Any, Any, Any], None] = xacro.eval_all
        self.functions = guarded_functions(self._budget.steps)
        self._helpers = helpers_of(self._budget.steps)
        self.environment = policy.environment

    def safe_eval(self, text: str, names: dict[str, Any], _locals: object = None) -> Any:  # noqa: ANN401
        """Replace `xacro.safe_eval`."""
        code = compile_expression(text).code
        names.update(self._helpers)
        return eval(code, names)

    def eval_text(self, text: str, names: Any) -> Any:  # noqa: ANN401
        """Replace `xacro.eval_text`: count, and bound what comes out."""
        self._budget.evaluation()
        if xacro.macrostack:
            self._budget.depth(len(xacro.macrostack), "?")
        if len(text) * text.count("$") > _LEXED_LIMIT:
            raise too_large()
        value = made(self._eval_text(text, names))
        check_printable(value)
        if isinstance(value, str):
            self._budget.text(len(value))
        return value

    def eval_all(self, node: Any, macros: Any, symbols: Any) -> None:  # noqa: ANN401
        """Replace `xacro.eval_all`, which each element goes through: count."""
        self._budget.element()
        self._eval_all(node, macros, symbols)

    def open(self, path: str) -> io.TextIOWrapper:
        """Replace `open` inside the xacro module."""
        try:
            _, data = self._store.read(path)
        except Refusal as refusal:
            raise _RefusedOpenError(refusal, path) from None
        except Fault as fault:
            if not os.path.lexists(path):
                raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path) from None
            raise OSError(errno.EACCES, fault.sentence, path) from None
        _refuse_bombs(path, data)
        return io.TextIOWrapper(io.BytesIO(data), encoding="utf-8")

    def glob(self, pattern: str) -> list[str]:
        """Replace `glob.glob` inside the xacro module."""
        return self._store.glob(pattern)

    def evaluate_substitution(self, text: str, _context: object) -> str:
        """Replace `substitution_args._eval`: the inside of `$(eval ...)`."""
        return evaluate(text, self)

    def variable(self, name: str) -> str:
        """Replace `substitution_args._eval_env`."""
        return variable(name, self)

    def optional_variable(self, name: str, default: str = "") -> str:
        """Replace `substitution_args._eval_optenv`."""
        return self.environment.get(name, default)

    def argument(self, name: str) -> str:
        """Return the value of an arg."""
        try:
            return xacro.substitution_args_context["arg"][name]
        except KeyError:
            raise Fault("undefined-argument", f'The arg "{name}" is not given.') from None

    def find_package(self, name: str) -> str:
        """Return the folder of a package, seen from the file being processed."""
        return find_package(self._policy.packages, name, xacro.filestack[-1])

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        """Return the items of a loop, each counted."""
        return self._budget.steps(items)


def _refuse_bombs(path: str, data: bytes) -> None:
    if not data.lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"<"):
        check_aliases(data)
        return
    try:
        parse_source(path, data)
    except SourceError as error:
        if error.code in {"xml-entity", "xml-too-deep"}:
            raise Refusal(error.code, error.sentence) from None


@contextmanager
def _on(guard: _Guard) -> Generator[None]:
    """Put the guard on for one run."""
    METHODS[xacro.YamlDictWrapper] = METHODS[dict]
    METHODS[xacro.YamlListWrapper] = METHODS[list]
    symbols = xacro._global_symbols
    with ExitStack() as stack:
        for name in ("safe_eval", "eval_text", "eval_all"):
            stack.enter_context(patch.object(xacro, name, getattr(guard, name)))
        stack.enter_context(patch.object(xacro, "open", guard.open, create=True))
        stack.enter_context(patch.object(xacro, "glob", guard))
        stack.enter_context(patch.object(xacro, "all_includes", []))
        for name, function in (
            ("_eval", guard.evaluate_substitution),
            ("_eval_env", guard.variable),
            ("_eval_optenv", guard.optional_variable),
            ("_eval_find", guard.find_package),
        ):
            stack.enter_context(patch.object(substitution_args, name, function))
        stack.enter_context(patch.object(xacro, "parse_macro_arg", _parameter))
        for table in (symbols, symbols["python"], symbols["math"], symbols["xacro"]):
            stack.enter_context(_replaced(table, guard.functions))
        yield


def _parameter(text: str) -> tuple[str, tuple[str | None, str | None] | None, str]:
    """Replace `xacro.parse_macro_arg`, whose pattern some texts keep busy without end."""
    if len(text) > PARAMS_LIMIT:
        raise too_large()
    name, default, rest = parameter(text)
    found = None if default is None else (name if default.forward else None, default.text)
    return name, found, rest


@contextmanager
def _replaced(table: dict[str, Any], bounded: dict[str, Any]) -> Generator[None]:
    """Swap functions of one of xacro's tables; nothing that a run does to it stays."""
    before = dict(table)
    dict.update(table, {name: value for name, value in bounded.items() if name in before})
    dict.pop(table, "vars", None)
    try:
        yield
    finally:
        dict.clear(table)
        dict.update(table, before)
