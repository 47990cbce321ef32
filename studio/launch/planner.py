"""Planner: visits a launch file and notes what it would do; it starts nothing."""

from __future__ import annotations

import os
import shlex
from typing import TYPE_CHECKING, Any, Final

from studio.errors import LaunchError, TooManyActionsError
from studio.launch.hosting import BaseHost, choice_fault, fault_at
from studio.launch.parameters_of import planned_parameters
from studio.launch.plan import (
    Plan,
    PlannedArgument,
    PlannedCondition,
    PlannedFailure,
    PlannedGap,
    PlannedHappening,
    PlannedInclude,
    PlannedLog,
    PlannedNode,
    PlannedProcess,
    PlannedRemap,
    PlannedSetting,
    PlannedStart,
    Where,
)
from studio.launch.robots import Robots
from studio.launch.shares import real_paths, why_not_installed
from studio.launch.starting import beginning_of
from studio.launch.vocabulary import actions, processes
from studio.launch.vocabulary.conditions import UnknownTruthError
from studio.launch.vocabulary.handlers import target_name
from studio.launch.vocabulary.requests import Later, Request
from studio.launch.vocabulary.texts import described, is_unknown, perform

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.launch.starting import Beginning
    from studio.launch.vocabulary.context import LaunchContext
    from studio.packages.index import PackageIndex

THINGS_MAX: Final = 2_000
"""Nodes and processes of one plan."""
ROWS_MAX: Final = 500
_LATER_DEPTH: Final = 6
_TEXT_MAX: Final = 20_000
_SHOWN_WHERE_FALSE: Final = (
    processes.ExecuteLocal,
    actions.LogInfo,
    actions.DeclareLaunchArgument,
    actions.SetEnvironmentVariable,
    actions.GroupAction,
    actions.IncludeLaunchDescription,
    actions.TimerAction,
)
"""What is shown though its condition does not hold."""


class PlanEndedError(BaseException):
    """There is too much to plan; no code of a launch file may catch it."""


class Planner(BaseHost):
    """Notes what is visited; `plan` gives it."""

    plans = True

    def __init__(self, index: PackageIndex, file: Path, given: Mapping[str, str]) -> None:
        super().__init__(index, file)
        self.file, self.given = file, dict(given)
        self.robots = Robots(real_paths)
        self._conditions: list[PlannedCondition] = []
        self._whens: list[str] = []
        self._included: list[int] = []
        self._arguments: list[PlannedArgument] = []
        self._nodes: list[PlannedNode] = []
        self._processes: list[PlannedProcess] = []
        self._includes_found: list[PlannedInclude] = []
        self._happenings: list[PlannedHappening] = []
        self._settings: list[PlannedSetting] = []
        self._log: list[PlannedLog] = []
        self._unsupported: dict[tuple[str, str], PlannedGap] = {}
        self._failures: list[PlannedFailure] = []
        self._not_installed: set[str] = set()
        self._starts: dict[tuple[str, str, str], Beginning] = {}

    def run(self, context: LaunchContext) -> None:
        """Visit the whole file; what fails is noted."""
        from studio.launch.vocabulary.sources import AnyLaunchDescriptionSource  # noqa: PLC0415

        context.launch_configurations.update(self.given)
        try:
            path, description = self.read_include(
                AnyLaunchDescriptionSource(str(self.file)), context
            )
            self._note_installed(path)
            self.walk_included(path, description, context)
        except Exception as error:  # noqa: BLE001 - as above
            fault = fault_at(error, None)
            self.failed(fault.reason, Where(fault.path, fault.line))

    def plan(self, ended: str = "") -> Plan:
        """Return what was noted."""
        declared = {one.name for one in self._arguments}
        return Plan(
            str(self.file),
            arguments=tuple(self._arguments),
            nodes=tuple(self._nodes),
            processes=tuple(self._processes),
            includes=tuple(self._includes_found),
            happenings=tuple(self._happenings),
            settings=tuple(self._settings),
            log=tuple(self._log),
            robots=self.robots.all(),
            unsupported=tuple(self._unsupported.values()),
            failures=tuple(self._failures),
            unknown=tuple(sorted(set(self.given) - declared)),
            ended=ended,
        )

    # What happens as actions are visited.

    def visit(self, entity: Any, context: LaunchContext) -> None:
        """Visit one with its condition; what fails is noted, and the rest goes on."""
        condition = (
            getattr(entity, "condition", None) if isinstance(entity, actions.Action) else None
        )
        if condition is None or not hasattr(condition, "evaluate"):
            self._attempt(entity, context)
            return
        self._conditions.append(
            PlannedCondition(_short(condition.describe()), self._holds(entity, context))
        )
        try:
            if self._conditions[-1].holds is False:
                self._visit_false(entity, context)
            else:
                self._attempt(entity, context)
        finally:
            self._conditions.pop()

    def _holds(self, entity: Any, context: LaunchContext) -> bool | None:
        try:
            return bool(entity.condition.evaluate(context))
        except UnknownTruthError:
            return None
        except Exception as error:  # noqa: BLE001 - as above
            self._fail(error, entity)
            return None

    def _visit_false(self, entity: Any, context: LaunchContext) -> None:
        """Show what is not done; nothing of it is set for what follows."""
        if not isinstance(entity, _SHOWN_WHERE_FALSE):
            return
        context.push()
        failures, unsupported = len(self._failures), dict(self._unsupported)
        try:
            self._attempt(entity, context)
        finally:
            context.pop()
            del self._failures[failures:]
            self._unsupported = unsupported

    def _attempt(self, entity: Any, context: LaunchContext) -> None:
        condition = getattr(entity, "condition", None)
        try:
            if condition is None:
                super().visit(entity, context)
                return
            inner: Any = entity.execute(context)
            self.walk(inner if isinstance(inner, list | tuple) else [inner], context)
        except TooManyActionsError as error:
            raise PlanEndedError(str(error)) from error
        except Exception as error:  # noqa: BLE001 - as above
            self._fail(error, entity)

    def _fail(self, error: Exception, entity: Any) -> None:
        fault = fault_at(error, entity)
        self.failed(fault.reason, Where(fault.path, fault.line))

    def declare(self, argument: actions.DeclareLaunchArgument, context: LaunchContext) -> None:
        """Note an argument; one without a value is `$(var NAME)` from here on."""
        default = None if argument.default_value is None else described(argument.default_value)
        value: str | None = None
        try:
            value = self.value_of_argument(argument, context)
            if value is not None and (fault := choice_fault(argument, value)):
                self.failed(fault, argument.where)
        except Exception as error:  # noqa: BLE001 - as above
            self._fail(error, argument)
        unknown = f"$(var {argument.name})"
        context.launch_configurations[argument.name] = unknown if value is None else value
        if len(self._arguments) >= THINGS_MAX:
            raise PlanEndedError(f"it declares more than {THINGS_MAX} arguments")
        self._arguments.append(
            PlannedArgument(
                argument.name,
                None if default is None else self._shown(default),
                tuple(argument.choices or ()),
                argument.description,
                None if value in (None, unknown) else self._shown(value or ""),
                argument.name in self.given,
                self._place(argument.where),
                self._include,
                self._condition,
            )
        )

    def start(self, request: Request, context: LaunchContext) -> None:
        """Note a node or a command, and what its end leads to."""
        if len(self._nodes) + len(self._processes) >= THINGS_MAX:
            raise PlanEndedError(f"it starts more than {THINGS_MAX} nodes and commands")
        number = len(self._nodes) + len(self._processes) + 1
        if request.kind == "process":
            self._processes.append(self._process(number, request))
        else:
            self._nodes.append(self._node(number, request))
        if request.on_exit is not None:
            when = f"when {target_name(request.action)} exits"
            self.later(Later("on_exit", when, request.on_exit, where=request.where), context)

    def later(self, later: Later, context: LaunchContext) -> None:
        """Note what is done later, and plan it one level down."""
        entities = later.entities
        is_function = callable(entities) and not isinstance(entities, actions.Action)
        listed = [] if is_function or entities is None else _as_list(entities)
        does = tuple(_short(real_paths(_described(one))) for one in listed)
        if is_function:
            name = getattr(entities, "__name__", "")
            named = "" if name in ("", "<lambda>", "handle") else f": {name}"
            does = (f"a function decides then{named}",)
        whole = self._when_with(later.when)
        self._append_row(
            self._happenings,
            PlannedHappening(
                later.kind, whole, does, self._condition, self._include, self._place(later.where)
            ),
        )
        if len(self._whens) >= _LATER_DEPTH:
            return
        self._whens.append(later.when)
        try:
            self.walk(listed, context.snapshot())
        finally:
            self._whens.pop()

    def forget(self, handle: Any) -> None:
        """Do nothing: handlers do not run here."""

    def emit(self, event: Any, context: LaunchContext) -> None:
        """Note an event that happens at once; that of a handler is among what the handler does."""
        del context
        if not self._whens:
            reason = getattr(event, "reason", "")
            text = f"emit {type(event).__name__}{f' ({reason})' if reason else ''}"
            row = PlannedHappening("other", "at once", (text,), self._condition, self._include)
            self._append_row(self._happenings, row)

    def include(
        self,
        source: actions.IncludeLaunchDescription,
        given: dict[str, str],
        context: LaunchContext,
    ) -> None:
        """Note an include and visit it."""
        location = source.launch_description_source
        number = len(self._includes_found)
        self._includes_found.append(
            PlannedInclude(
                number,
                self._shown(perform(context, location.location)) if location.location else "",
                {name: self._shown(value) for name, value in given.items()},
                self._include,
                self._condition,
                self._when,
                self._place(source.where),
            )
        )
        if self._is_left_out:
            return
        context.launch_configurations.update(given)
        try:
            _refuse_unknown(self._includes_found[number].file)
            path, description = self.read_include(location, context)
        except Exception as error:  # noqa: BLE001 - as above
            fault = fault_at(error, source)
            self._includes_found[number] = _with_failure(self._includes_found[number], fault.reason)
            self.failed(fault.reason, Where(fault.path, fault.line))
            return
        self._note_installed(path)
        self._included.append(number)
        try:
            self.walk_included(path, description, context)
        finally:
            self._included.pop()

    def log(self, level: str, text: str, where: Where) -> None:
        """Note a line of the log."""
        shown = text if level == "info" else f"{level.upper()}: {text}"
        row = PlannedLog(self._shown(shown), self._condition, self._when, self._place(where))
        self._append_row(self._log, row)

    def set_environment(self, name: str, value: str | None, where: Where) -> None:
        """Note a variable, and set it for what follows."""
        shown = None if value is None else self._shown(value)
        row = PlannedSetting(name, shown, self._condition, self._place(where))
        self._append_row(self._settings, row)
        super().set_environment(name, value, where)

    def output_of(self, line: str, on_stderr: str, where: Where) -> str:
        """Return a stand-in of what a command would print: a robot's, where it makes one."""
        del on_stderr
        text = self.robots.of_command(line, where)
        if text is not None:
            return text
        first = (shlex.split(line) or [""])[0] if '"' not in line and "'" not in line else line
        self.unsupported(
            "Command",
            f"not run while planning: the command {_short(line)!r}, what it prints is not known",
            where,
        )
        return f"$(unsupported {os.path.basename(first).translate({40: '[', 41: ']'})})"  # noqa: PTH119

    def note_file(self, path: str) -> None:
        """Take a file, which may be a robot's."""
        self.robots.note_file(path)

    def unsupported(self, name: str, sentence: str, where: Where) -> None:
        """Note what is left out, once for each line."""
        if len(self._unsupported) < ROWS_MAX:
            place = self._place(where)
            self._unsupported.setdefault((name, str(place)), PlannedGap(name, sentence, place))

    def failed(self, sentence: str, where: Where) -> None:
        """Note what went wrong."""
        row = PlannedFailure(_short(real_paths(sentence), 2_000), self._place(where))
        if row not in self._failures:
            self._append_row(self._failures, row)

    # What is noted with each thing.

    @property
    def _condition(self) -> PlannedCondition | None:
        if not self._conditions:
            return None
        holds = [one.holds for one in self._conditions]
        whole = False if False in holds else None if None in holds else True
        return PlannedCondition(" and ".join(one.text for one in self._conditions), whole)

    @property
    def _is_left_out(self) -> bool:
        return any(one.holds is False for one in self._conditions)

    @property
    def _when(self) -> str:
        return ", then ".join(self._whens)

    def _when_with(self, last: str) -> str:
        return ", then ".join([*self._whens, last])

    @property
    def _include(self) -> int | None:
        return self._included[-1] if self._included else None

    def _shown(self, text: str) -> str:
        return _short(real_paths(text), _TEXT_MAX)

    def _place(self, where: Where) -> Where:
        return Where(real_paths(where.file), where.line)

    @staticmethod
    def _append_row(rows: list[Any], row: Any) -> None:
        if len(rows) < ROWS_MAX:
            rows.append(row)

    def _note_installed(self, path: str) -> None:
        from pathlib import Path  # noqa: PLC0415

        real = os.path.realpath(path)
        if path and real not in self._not_installed:
            self._not_installed.add(real)
            if reason := why_not_installed(Path(real)):
                self.failed(reason, Where(real, 0))

    def _node(self, number: int, request: Request) -> PlannedNode:
        found = planned_parameters(request, self.robots, number)
        for sentence in found.failures:
            self.failed(sentence, request.where)
        for file in found.files:
            self._note_installed(file)
        arguments = tuple(self._shown(one) for one in request.arguments)
        self.robots.note_arguments(request, number)
        return PlannedNode(
            number,
            request.kind,
            request.package,
            request.executable,
            request.name,
            request.namespace,
            request.full_name,
            found.parameters,
            tuple(self._shown(one) for one in found.files),
            tuple(PlannedRemap(a, b) for a, b in request.remaps),
            arguments,
            tuple(self._shown(one) for one in request.ros_arguments),
            {name: self._shown(value) for name, value in request.environment.items()},
            request.output,
            request.respawn,
            request.respawn_delay_s,
            request.container,
            self._condition,
            self._when,
            self._include,
            self._place(request.where),
            self._start_of(request),
            tuple(self._shown(one) for one in request.prefix),
            self._shown(request.cwd),
        )

    def _start_of(self, request: Request) -> PlannedStart:
        key = (request.kind, request.package, request.executable)
        if key not in self._starts:
            self._starts[key] = beginning_of(self.index, request)
        if self._starts[key].fault and not self._is_left_out:
            self.failed(self._starts[key].fault, request.where)
        return self._starts[key].start

    def _process(self, number: int, request: Request) -> PlannedProcess:
        return PlannedProcess(
            number,
            tuple(self._shown(one) for one in request.command),
            request.name,
            request.shell,
            self._shown(request.cwd),
            {name: self._shown(value) for name, value in request.environment.items()},
            request.output,
            request.respawn,
            request.respawn_delay_s,
            self._condition,
            self._when,
            self._include,
            self._place(request.where),
            beginning_of(self.index, request).start,
        )


def _with_failure(include: PlannedInclude, reason: str) -> PlannedInclude:
    from dataclasses import replace  # noqa: PLC0415

    return replace(include, failed=real_paths(reason))


def _refuse_unknown(file: str) -> None:
    if is_unknown(file):
        raise LaunchError("which file depends on an argument that has no value")


def _as_list(entities: Any) -> list[Any]:
    return list(entities) if isinstance(entities, list | tuple) else [entities]  # pyright: ignore


def _described(entity: Any) -> str:
    describe = getattr(entity, "describe", None)
    try:
        return str(describe()) if callable(describe) else type(entity).__name__
    except Exception:  # noqa: BLE001 - a class of the launch file's own
        return type(entity).__name__


def _short(text: str, letters: int = 300) -> str:
    return text if len(text) <= letters else f"{text[: letters - 3]}..."
