"""Checks of what nodes do: are they spun, do callbacks block, do services and actions answer."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.packages.edits.python_edits import import_added
from studio.packages.lint.checked import ERROR, WARNING, edit, found
from studio.packages.sources.interfaces import KINDS
from studio.packages.sources.python_file import last_name

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.python_file import PythonFile
    from studio.problems import Fix, Problem, Replacement

_Function: TypeAlias = ast.FunctionDef | ast.AsyncFunctionDef
_SPINS: Final = frozenset(
    {"spin", "spin_once", "spin_until_future_complete", "spin_once_until_future_complete"}
)
_MAKES: Final = {
    "create_subscription": (2, "callback"),
    "create_timer": (1, "callback"),
    "create_service": (2, "callback"),
    "ActionServer": (3, "execute_callback"),
}
"""Where each of these takes its callback: by place (of 0), by name."""


@dataclass(frozen=True)
class _Nodes:
    """The classes of nodes in a file, and which of their methods are callbacks of what."""

    python: PythonFile

    @cached_property
    def classes(self) -> tuple[ast.ClassDef, ...]:
        names = {"Node", "LifecycleNode"}
        return tuple(
            one
            for one in self.python.nodes
            if isinstance(one, ast.ClassDef) and any(last_name(base) in names for base in one.bases)
        )

    @cached_property
    def functions(self) -> dict[str, _Function]:
        kinds = (ast.FunctionDef, ast.AsyncFunctionDef)
        return {one.name: one for one in self.python.nodes if isinstance(one, kinds)}

    @cached_property
    def calls(self) -> tuple[ast.Call, ...]:
        return tuple(one for one in self.python.nodes if isinstance(one, ast.Call))

    @cached_property
    def names(self) -> frozenset[str]:
        """Every name and attribute of the file."""
        return frozenset(filter(None, map(last_name, self.python.nodes)))

    @cached_property
    def callbacks(self) -> dict[str, tuple[str, ast.Call]]:
        """By the name of a function: what calls it, and where it was given."""
        found: dict[str, tuple[str, ast.Call]] = {}
        for call in self.calls:
            what = called(call)
            if what in _MAKES:
                place, keyword = _MAKES[what]
                given = next((one.value for one in call.keywords if one.arg == keyword), None)
                if given is None and len(call.args) > place:
                    given = call.args[place]
                name = last_name(given)
                if name in self.functions:
                    found[name] = (what, call)
        return found


def called(call: ast.Call) -> str:
    """Return the last word of what is called."""
    return last_name(call.func)


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield what would stand still, answer nothing, or fail at its first call."""
    for python in checked.python_files:
        if python.tree is None or not python.source.is_utf8:
            continue
        nodes = _Nodes(python)
        if "rclpy" not in {one.package for one in python.imports} and not nodes.classes:
            continue
        yield from _shadowed(nodes)
        yield from _main(checked, nodes)
        yield from _loops(nodes)
        yield from _blocking(nodes)
        yield from _answers(nodes)
        yield from _goals(nodes)
        yield from _parameters(nodes)


def _shadowed(nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    types = {
        one.bound: one.module for one in python.imports if one.module.rpartition(".")[2] in KINDS
    }
    for one in python.nodes:
        if isinstance(one, ast.ClassDef) and one.name in types:
            right = f"{one.name}Node"
            sentence = (
                f'The class "{one.name}" hides the type {types[one.name]}.{one.name}: '
                f"call the class {right}, say."
            )
            at = python.span(one)[0]
            start = python.source.data.find(one.name.encode(), at)
            mend = _class_renamed(python, one, start, right)
            yield found(ERROR, "class-hides-type", sentence, python.source, start, mend)


def _class_renamed(python: PythonFile, one: ast.ClassDef, start: int, right: str) -> Fix | None:
    """Rename the class, and where it is made: a call of its name outside of it."""
    end = start + len(one.name.encode())
    changes = [python.source.replaced(start, end, right)]
    inside = set(map(id, ast.walk(one)))
    changes += [
        python.source.replaced(*python.span(node.func), right)
        for node in python.nodes
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == one.name
        and id(node) not in inside
    ]
    return edit(f"Call the class {right}", *changes)


def _main(checked: CheckedPackage, nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    tree = python.tree
    if tree is None:
        return
    spins = {*nodes.names} & _SPINS
    guard = any(isinstance(one, ast.If) and _is_guard(one) for one in tree.body)
    starts = any(called(one) == "init" for one in nodes.calls)
    if nodes.classes and "main" not in python.top_level_names and not guard and not starts:
        if not _is_imported(checked, python):
            yield _without_main(nodes)
        return
    works = any(called(one) in _MAKES or called(one) == "create_client" for one in nodes.calls)
    made = _made_nodes(nodes)
    if (
        starts
        and works
        and made
        and not spins
        and not any(called(one) in {"start", "Thread"} for one in nodes.calls)
    ):
        at, mend = python.span(made[0])[0], _spun(nodes, made)
        sentence = "The node is made and never spun: no callback of it is ever called."
        yield found(ERROR, "never-spun", sentence, python.source, at, mend)


def _is_guard(node: ast.If) -> bool:
    return any(getattr(one, "id", "") == "__name__" for one in ast.walk(node.test))


def _is_imported(checked: CheckedPackage, python: PythonFile) -> bool:
    stem = python.source.file.rpartition("/")[2].removesuffix(".py")
    return any(
        stem in (one.module.rpartition(".")[2], one.name)
        for other in checked.python_files
        if other is not python
        for one in other.imports
    )


def _without_main(nodes: _Nodes) -> Problem:
    python, node = nodes.python, nodes.classes[-1]
    source = python.source
    init = next(
        (one for one in node.body if isinstance(one, ast.FunctionDef) and one.name == "__init__"),
        None,
    )
    plain = init is None or (len(init.args.args) == 1 and not init.args.kwonlyargs)
    mend = None
    if plain and len(nodes.classes) == 1:
        eol = source.line_break
        lines = [
            *("", "", "def main(args=None):", "    rclpy.init(args=args)"),
            *(f"    node = {node.name}()", "    rclpy.spin(node)", "    rclpy.shutdown()"),
            *("", "", "if __name__ == '__main__':", "    main()", ""),
        ]
        lead = "" if source.data.endswith(b"\n") else eol
        changes = [source.put_in(len(source.data), lead + eol.join(lines))]
        if "rclpy" not in python.top_level_names:
            changes.insert(0, import_added(python, "import rclpy"))
        mend = edit("Add main()", *changes)
    sentence = f"{node.name} is a node that nobody starts: the file has no main()."
    return found(ERROR, "no-main", sentence, source, python.span(node)[0], mend)


def _made_nodes(nodes: _Nodes) -> list[ast.Assign]:
    """Return the assignments of a node that is made outside of classes."""
    names = {one.name for one in nodes.classes}
    inside = {id(inner) for one in nodes.classes for inner in ast.walk(one)}
    return [
        one
        for one in nodes.python.nodes
        if isinstance(one, ast.Assign)
        and id(one) not in inside
        and isinstance(one.value, ast.Call)
        and (called(one.value) in names or called(one.value) == "create_node")
    ]


def _spun(nodes: _Nodes, made: list[ast.Assign]) -> Fix | None:
    source, python = nodes.python.source, nodes.python
    last = made[-1]
    target = last.targets[0]
    if len(made) != 1 or not isinstance(target, ast.Name):
        return None
    _, end = python.span(last)
    line = f"{source.line_break}{source.indent_at(end)}rclpy.spin({target.id})"
    return edit("Spin it", source.put_in(end, line))


def _loops(nodes: _Nodes) -> Iterator[Problem]:
    for function in nodes.functions.values():
        is_init = function.name == "__init__" and any(function in one.body for one in nodes.classes)
        if not is_init and function.name not in nodes.callbacks:
            continue
        if is_init:
            loop = next((one for one in _own(function) if _is_endless(one)), None)
        else:
            what = nodes.callbacks[function.name][0]
            loops = (one for one in _own(function) if _is_endless(one))
            loop = next(loops, None) if what != "ActionServer" else None
        if not isinstance(loop, ast.While):
            continue
        where = "while the node is made" if is_init else f"in the callback {function.name}"
        sentence = (
            f"This loop runs for ever {where}: the node is never spun and does nothing else. "
            "A timer does a thing again and again: self.create_timer(0.5, self.tick)."
        )
        at = nodes.python.span(loop)[0]
        yield found(ERROR, "endless-loop", sentence, nodes.python.source, at)


def _is_endless(node: ast.AST) -> bool:
    if not isinstance(node, ast.While):
        return False
    always = isinstance(node.test, ast.Constant) and bool(node.test.value)
    while_ok = isinstance(node.test, ast.Call) and called(node.test) == "ok"
    inner = list(ast.walk(node))
    ends = any(isinstance(one, ast.Break | ast.Return | ast.Raise) for one in inner)
    spins = any(isinstance(one, ast.Call) and called(one) in _SPINS for one in inner)
    return (always or while_ok) and not ends and not spins


def _own(function: _Function) -> Iterator[ast.AST]:
    """Yield the nodes of a function, without those of functions inside it."""
    waiting: list[ast.AST] = list(function.body)
    while waiting:
        one = waiting.pop(0)
        yield one
        if not isinstance(one, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda | ast.ClassDef):
            waiting += ast.iter_child_nodes(one)


def _blocking(nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    threads = "MultiThreadedExecutor" in nodes.names
    clients = {
        last_name(one.targets[0])
        for one in python.nodes
        if isinstance(one, ast.Assign)
        and isinstance(one.value, ast.Call)
        and called(one.value) == "create_client"
    }
    for name, (what, _) in nodes.callbacks.items():
        function = nodes.functions[name]
        calm = what == "ActionServer"  # its goals take their time: that is what they are for
        for one in _own(function):
            if not isinstance(one, ast.Call):
                continue
            word = last_name(getattr(one.func, "value", None))
            at = python.span(one)[0]
            if called(one) in _SPINS and word == "rclpy":
                sentence = (
                    f"{called(one)} in the callback {name} waits for what only the executor can "
                    "bring, which waits for this callback: add a done callback to the future."
                )
                yield found(ERROR, "spin-in-callback", sentence, python.source, at)
            elif called(one) == "call" and word in clients and not threads:
                sentence = (
                    f"call() in the callback {name} waits for ever: use call_async() and add a "
                    "done callback."
                )
                yield found(ERROR, "call-in-callback", sentence, python.source, at)
            elif called(one) == "sleep" and word != "asyncio" and not (calm or threads):
                sentence = (
                    f"sleep in the callback {name} keeps every other callback of the node waiting: "
                    "use a timer."
                )
                yield found(WARNING, "sleep-in-callback", sentence, python.source, at)
    yield from _asyncio(nodes)


def _asyncio(nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    loops = {
        called(one)
        for one in nodes.calls
        if getattr(getattr(one.func, "value", None), "id", "") == "asyncio"
    }
    if "rclpy" not in {one.package for one in python.imports} or "run" in loops:
        return
    for one in python.nodes:
        if not isinstance(one, ast.Await) or not isinstance(one.value, ast.Call):
            continue
        owner = getattr(one.value.func, "value", None)
        if called(one.value) == "sleep" and getattr(owner, "id", "") == "asyncio":
            start, end = python.span(one)
            inner = ", ".join(python.source.slice(*python.span(arg)) for arg in one.value.args)
            changes: list[Replacement] = []
            if "time" not in python.top_level_names:
                changes.append(import_added(python, "import time"))
            changes.append(python.source.replaced(start, end, f"time.sleep({inner})"))
            sentence = (
                "asyncio.sleep needs a loop of asyncio, which rclpy does not run: it raises "
                "RuntimeError. time.sleep waits."
            )
            mend = edit("Write time.sleep", *changes)
            yield found(ERROR, "asyncio-sleep", sentence, python.source, start, mend)


def _answers(nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    for name, (what, call) in nodes.callbacks.items():
        function = nodes.functions[name]
        if what not in {"create_service", "ActionServer"} or not function.body:
            continue
        inner = list(_own(function))
        if any(isinstance(one, ast.Return) and one.value is not None for one in inner):
            continue
        if any(isinstance(one, ast.Raise) for one in function.body):
            continue
        arguments = [one.arg for one in function.args.args if one.arg != "self"]
        at = python.span(function)[0]
        if what == "create_service":
            answer = arguments[1] if len(arguments) > 1 else ""
            sentence = (
                f"{name} returns nothing: the callback of a service returns the response, "
                f"return {answer or 'response'}."
            )
            mend = _returned(python, function, answer)
            yield found(ERROR, "response-not-returned", sentence, python.source, at, mend)
        else:
            answer = _result_of(nodes, inner, call)
            sentence = (
                f"{name} returns nothing: the callback of an action returns its result, "
                f"return {answer or 'result'}."
            )
            mend = _returned(python, function, answer)
            yield found(ERROR, "result-not-returned", sentence, python.source, at, mend)


def _result_of(nodes: _Nodes, inner: list[ast.AST], call: ast.Call) -> str:
    for one in inner:
        if isinstance(one, ast.Assign) and isinstance(one.value, ast.Call):
            target = one.targets[0]
            if called(one.value) == "Result" and isinstance(target, ast.Name):
                return target.id
    kind = call.args[1] if len(call.args) > 1 else None
    return f"{kind.id}.Result()" if isinstance(kind, ast.Name) else ""


def _returned(python: PythonFile, function: _Function, answer: str) -> Fix | None:
    if not answer:
        return None
    last = function.body[-1]
    _, end = python.span(last)
    indent = python.source.indent_at(python.span(function.body[0])[0])
    if python.source.line_of(python.span(function.body[0])[0]) == function.lineno:
        return None
    stop = python.source.line_end(end)
    eol = python.source.line_break
    lead = "" if python.source.data[:stop].endswith(b"\n") else eol
    line = f"{lead}{indent}return {answer}{eol}"
    return edit(f"Return {answer}", python.source.put_in(stop, line))


def _goals(nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    for one in nodes.calls:
        if called(one) == "get_result_async" and "accepted" not in nodes.names:
            sentence = (
                "Nobody asks whether the goal was accepted: goal_handle.accepted says so, and of a "
                "rejected goal no result ever comes."
            )
            at = python.span(one)[0]
            yield found(WARNING, "goal-not-checked", sentence, python.source, at)
            break
    for name, (what, _) in nodes.callbacks.items():
        function = nodes.functions[name]
        ends = {"succeed", "abort", "canceled"}
        if (
            what != "ActionServer"
            or {called(c) for c in _own(function) if isinstance(c, ast.Call)} & ends
        ):
            continue
        if len(function.args.args) < 1:
            continue
        sentence = f"{name} never calls goal_handle.succeed(): the goal ends as aborted."
        at = python.span(function)[0]
        yield found(WARNING, "goal-never-succeeds", sentence, python.source, at)


def _parameters(nodes: _Nodes) -> Iterator[Problem]:
    yield from _sim_time(nodes)
    yield from _results(nodes)


def _sim_time(nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    for one in nodes.calls:
        first = one.args[0] if one.args else None
        if called(one) == "declare_parameter" and getattr(first, "value", "") == "use_sim_time":
            alone = next(
                (s for s in python.nodes if isinstance(s, ast.Expr) and s.value is one), None
            )
            at = python.span(one)[0]
            mend = None
            if alone is not None and _has_siblings(python, alone):
                mend = edit("Remove the line", python.source.without_lines(*python.span(alone)))
            sentence = (
                "Every node has use_sim_time already: to declare it again raises "
                "ParameterAlreadyDeclaredException. Only read it."
            )
            yield found(ERROR, "use-sim-time-declared", sentence, python.source, at, mend)


def _results(nodes: _Nodes) -> Iterator[Problem]:
    python = nodes.python
    for node in python.nodes:
        if isinstance(node, ast.Attribute) and node.attr == "SetParametersResult":
            text = python.source.slice(*python.span(node.value))
            if text == "rclpy.node":
                line = "from rcl_interfaces.msg import SetParametersResult"
                changes = [python.source.replaced(*python.span(node), "SetParametersResult")]
                if "SetParametersResult" not in python.top_level_names:
                    changes.insert(0, import_added(python, line))
                yield _result_type(nodes, node, edit("Import it of rcl_interfaces.msg", *changes))
    for one in python.imports:
        if one.module == "rclpy.node" and one.name == "SetParametersResult":
            mend = None
            if len(one.node.names) == 1:
                start, end = python.span(one.node)
                right = "from rcl_interfaces.msg import SetParametersResult"
                mend = edit(f"Write {right}", python.source.replaced(start, end, right))
            yield _result_type(nodes, one.alias, mend)


def _result_type(nodes: _Nodes, node: ast.expr | ast.alias, mend: Fix | None) -> Problem:
    sentence = "SetParametersResult is of rcl_interfaces.msg: that rclpy.node has it is by chance."
    python = nodes.python
    return found(
        WARNING, "set-parameters-result", sentence, python.source, python.span(node)[0], mend
    )


def _has_siblings(python: PythonFile, statement: ast.stmt) -> bool:
    """Whether the block is not empty without a statement."""
    for node in python.nodes:
        for block in ("body", "orelse", "finalbody"):
            statements = getattr(node, block, None)
            if isinstance(statements, list) and statement in statements:
                return len(statements) > 1  # pyright: ignore[reportUnknownArgumentType]
    return False


_STANDS: Final = {
    "en": "A node does its work in callbacks, which an executor calls one after the other.",
    "de": "Eine Node arbeitet in Callbacks, die ein Executor nacheinander aufruft.",
}
WHY: Final = {
    "class-hides-type": {
        "en": "One name means one thing: after the class it no longer means the type.",
        "de": "Ein Name bedeutet eines: Nach der Klasse meint er nicht mehr den Typ.",
    },
    "no-main": {
        "en": "An executable is a function that is called: main() makes the node and spins it.",
        "de": "Ein Programm ist eine Funktion: main() legt die Node an und lässt sie laufen.",
    },
    "never-spun": _STANDS,
    "endless-loop": _STANDS,
    "spin-in-callback": {
        "en": "The executor is already at work in this callback: both wait for each other.",
        "de": "Der Executor arbeitet schon in diesem Callback: Beide warten aufeinander.",
    },
    "call-in-callback": {
        "en": "The answer is brought by the executor, which waits for this callback.",
        "de": "Die Antwort bringt der Executor, und der wartet auf diesen Callback.",
    },
    "sleep-in-callback": _STANDS,
    "asyncio-sleep": {
        "en": "rclpy runs coroutines by itself, without asyncio.",
        "de": "rclpy führt Koroutinen selbst aus, ohne asyncio.",
    },
    "response-not-returned": {
        "en": "The server fails where it sends the response, and the client waits for ever.",
        "de": "Der Server scheitert beim Senden der Antwort, und der Client wartet für immer.",
    },
    "result-not-returned": {
        "en": "The client gets an empty result instead of the one that was worked out.",
        "de": "Der Client bekommt ein leeres Ergebnis statt des berechneten.",
    },
    "goal-not-checked": {
        "en": "A server may refuse a goal; the client then waits for a result for ever.",
        "de": "Ein Server darf ein Ziel ablehnen; der Client wartet dann für immer.",
    },
    "goal-never-succeeds": {
        "en": "A goal that nobody ends is taken for aborted.",
        "de": "Ein Ziel, das niemand beendet, gilt als abgebrochen.",
    },
    "use-sim-time-declared": {
        "en": "rclpy declares this parameter for every node.",
        "de": "rclpy deklariert diesen Parameter für jede Node.",
    },
    "set-parameters-result": {
        "en": "What a module imports for itself may be gone in the next release.",
        "de": "Was ein Modul für sich importiert, kann in der nächsten Version fehlen.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
