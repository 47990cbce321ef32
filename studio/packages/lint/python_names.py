"""Checks of names in Python files: imports that fail, unknown names, misspelt words of rclpy."""

from __future__ import annotations

import ast
import builtins
import sys
from typing import TYPE_CHECKING, Final

from studio.packages.edits.python_edits import import_added
from studio.packages.lint.checked import ERROR, WARNING, edit, found, meant
from studio.packages.lint.rclpy_names import CALL_PARTS, HOMES, NODE_NAMES, RCLPY_NAMES
from studio.packages.sources.interfaces import KINDS
from studio.packages.sources.python_file import bound_names, last_name, names_bound_by

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.python_file import Import, PythonFile
    from studio.problems import Fix, Problem

_ALWAYS: Final = frozenset(
    {*dir(builtins), "__file__", "__name__", "__doc__", "__package__", "__spec__", "__path__"}
)
_NAMES_MAX: Final = 20
"""Of one file: where more are unknown, its beginning is missing."""
_WORDS_LOOKED_AT_MAX: Final = 200


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield what Python would stop at."""
    for python in (*checked.python_files, *checked.launch_files):
        if python.tree is None:
            at = python.source.offset(python.fault_line or 1)
            sentence = f"This is no Python: {python.fault}."
            yield found(ERROR, "python-broken", sentence, python.source, at)
            continue
        if not python.source.is_utf8:
            continue
        yield from _imports(checked, python)
        yield from _unknown_names(checked, python)
        yield from _attributes(python)


def _imports(checked: CheckedPackage, python: PythonFile) -> Iterator[Problem]:
    for one in python.imports:
        package, _, kind = one.module.partition(".")
        if one.name and kind in KINDS and one.name != "*" and package:
            yield from _type_import(checked, python, one, package, kind)


def _type_import(
    checked: CheckedPackage, python: PythonFile, one: Import, package: str, kind: str
) -> Iterator[Problem]:
    types = checked.types_of(package)
    name = one.name
    if f"{package}/{kind}/{name}" in types or (not types and checked.has_package(package)):
        return
    at = python.span(one.node)[0]
    if owners := checked.packages_with_type(kind, name):
        right = _nearest(package, owners)
        sentence = f"{package} has no {kind} {name}: it is {right}.{kind} that has it."
        mend = _other_module(python, one, f"{right}.{kind}")
        yield found(ERROR, "type-of-other-package", sentence, python.source, at, mend)
        return
    others = [other for other in KINDS if f"{package}/{other}/{name}" in types]
    if others:
        sentence = f"{name} of {package} is no {kind}: import it of {package}.{others[0]}."
        mend = _other_module(python, one, f"{package}.{others[0]}")
        yield found(ERROR, "type-of-other-package", sentence, python.source, at, mend)
    elif types:
        names = [other.rpartition("/")[2] for other in types if f"/{kind}/" in other]
        right = meant(name, names, 0.7)
        hint = f": {right} is meant, it seems" if right else ""
        sentence = f"{package} has no {kind} {name}{hint}."
        mend = None
        if right and one.alias.asname is None and _times_named(python, name) < 2:
            start, end = python.span(one.alias)
            mend = edit(f"Write {right}", python.source.replaced(start, end, right))
        yield found(ERROR, "type-unknown", sentence, python.source, at, mend)
    elif not checked.has_package(package) and not _is_own_module(checked, package):
        sentence = f"No package {package} is known, of which {name} is imported."
        yield found(WARNING, "type-unknown", sentence, python.source, at)


def _is_own_module(checked: CheckedPackage, package: str) -> bool:
    return checked.source.has_folder(package) or checked.source.has(f"{package}.py")


def _nearest(package: str, owners: list[str]) -> str:
    """Return the owner that is written alike, else the first: those of the workspace are first."""
    return meant(package, owners, 0.6) or owners[0]


def _times_named(python: PythonFile, name: str) -> int:
    return sum(isinstance(node, ast.Name) and node.id == name for node in python.nodes)


def _other_module(python: PythonFile, one: Import, module: str) -> Fix | None:
    """Return the fix that imports of another module; of one of several names, nothing is safe."""
    if len(one.node.names) != 1:
        return None
    start, end = python.span(one.node)
    text = python.source.slice(start, end)
    if text.count(f"from {one.module} import") != 1:
        return None
    right = text.replace(f"from {one.module} import", f"from {module} import")
    return edit(f"Import of {module}", python.source.replaced(start, end, right))


def _unknown_names(checked: CheckedPackage, python: PythonFile) -> Iterator[Problem]:
    """Names that are used and made nowhere in the file, whatever the scope."""
    if any(one.name == "*" for one in python.imports):
        return
    made = {*_ALWAYS, *_made_anywhere(python)}
    used: dict[str, ast.Name] = {}
    for node in python.nodes:
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load) and node.id not in made:
            used.setdefault(node.id, node)
    for name, node in [*used.items()][:_NAMES_MAX]:
        yield _unknown_name(checked, python, name, node, made - _ALWAYS)


def _made_anywhere(python: PythonFile) -> Iterator[str]:
    for node in python.nodes:
        yield from names_bound_by(node)
        match node:
            case ast.arg(arg=name):
                yield name
            case ast.Global(names=names) | ast.Nonlocal(names=names):
                yield from names
            case _:
                pass


def _unknown_name(
    checked: CheckedPackage, python: PythonFile, name: str, node: ast.Name, made: set[str]
) -> Problem:
    start, end = python.span(node)
    line = _import_line(checked, name)
    if line:
        sentence = f'"{name}" is used and never imported: {line}.'
        mend = edit(f"Add {line}", import_added(python, line))
        return found(ERROR, "name-not-imported", sentence, python.source, start, mend)
    right = meant(name, made, 0.75) or _alike_class(python, name)
    hint = f": {right} is meant, it seems" if right else ""
    mend = edit(f"Write {right}", python.source.replaced(start, end, right)) if right else None
    sentence = f'"{name}" is used, and nothing of that name is made or imported{hint}.'
    return found(ERROR, "name-unknown", sentence, python.source, start, mend)


def _alike_class(python: PythonFile, name: str) -> str:
    """Return the only class of the file, where a name like a class is called and unknown."""
    classes = [one.name for one in python.nodes if isinstance(one, ast.ClassDef)]
    return classes[0] if len(classes) == 1 and name[:1].isupper() and "Node" in name else ""


def _import_line(checked: CheckedPackage, name: str) -> str:
    if name in HOMES:
        return f"from {HOMES[name]} import {name}"
    if name in {"rclpy", "tf2_ros"} or (name in sys.stdlib_module_names and name.islower()):
        return f"import {name}"
    owners = [(kind, one) for kind in KINDS for one in checked.packages_with_type(kind, name)]
    named = {one.text for one in checked.source.manifest.dependencies()}
    preferred = [row for row in owners if row[1] in named] or owners
    if len(preferred) == 1:
        kind, package = preferred[0]
        return f"from {package}.{kind} import {name}"
    return ""


def _attributes(python: PythonFile) -> Iterator[Problem]:
    kinds = {
        one.bound: one.module.rpartition(".")[2]
        for one in python.imports
        if one.name and one.module.rpartition(".")[2] in ("srv", "action")
    }
    said: set[tuple[str, str]] = set()
    for node in python.nodes:
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            owner = node.value.id
            if (owner, node.attr) in said or len(said) > _WORDS_LOOKED_AT_MAX:
                continue
            if owner in kinds or owner == "rclpy":
                said.add((owner, node.attr))
            if owner in kinds and node.attr not in CALL_PARTS[kinds[owner]]:
                yield from _misspelt(python, node, CALL_PARTS[kinds[owner]], f"{owner} has no")
            elif owner == "rclpy" and node.attr not in RCLPY_NAMES:
                yield from _misspelt(python, node, RCLPY_NAMES, "rclpy has no")
        elif isinstance(node, ast.ClassDef) and _is_node(node):
            yield from _of_node(python, node)
    for node in python.nodes:
        if isinstance(node, ast.Attribute) and node.attr == "create_action_server":
            sentence = (
                "rclpy has no create_action_server: rclpy.action has "
                "ActionServer(node, type, name, callback)."
            )
            yield _action_server(python, node, sentence)


def _action_server(python: PythonFile, node: ast.Attribute, sentence: str) -> Problem:
    call = next(
        (one for one in python.nodes if isinstance(one, ast.Call) and one.func is node), None
    )
    mend = None
    if call is not None and call.args:
        start, _ = python.span(node)
        first = python.span(call.args[0])[0]
        owner = python.source.slice(*python.span(node.value))
        changes = [python.source.replaced(start, first, f"ActionServer({owner}, ")]
        if "ActionServer" not in python.top_level_names:
            line = "from rclpy.action import ActionServer"
            changes.insert(0, import_added(python, line))
        mend = edit("Write ActionServer", *changes)
    return found(ERROR, "no-such-method", sentence, python.source, python.span(node)[0], mend)


def _is_node(node: ast.ClassDef) -> bool:
    names = set(map(last_name, node.bases))
    return len(names) == 1 and names <= {"Node", "LifecycleNode"}


def _of_node(python: PythonFile, node: ast.ClassDef) -> Iterator[Problem]:
    """Words behind `self.` that nobody set and that are close to one that is there."""
    inner = list(ast.walk(node))
    made = {one.name for one in inner if isinstance(one, ast.FunctionDef | ast.AsyncFunctionDef)}
    mine = [
        one
        for one in inner
        if isinstance(one, ast.Attribute)
        and isinstance(one.value, ast.Name)
        and one.value.id == "self"
    ]
    made |= {one.attr for one in mine if isinstance(one.ctx, ast.Store)}
    made |= {name for one in node.body for name in bound_names([one])}
    said: set[str] = set()
    for one in mine:
        known = one.attr in made or one.attr in NODE_NAMES or one.attr in said
        if known or one.attr == "create_action_server" or len(said) > _WORDS_LOOKED_AT_MAX:
            continue
        said.add(one.attr)
        yield from _misspelt(python, one, frozenset({*made, *NODE_NAMES}), "a node has no")


def _misspelt(
    python: PythonFile, node: ast.Attribute, known: frozenset[str], who: str
) -> Iterator[Problem]:
    right = meant(node.attr, known, 0.8)
    if not right:
        return
    _, end = python.span(node)
    start = end - len(node.attr.encode())
    sentence = f'"{node.attr}": {who} such name, {right} is meant.'
    mend = edit(f"Write {right}", python.source.replaced(start, end, right))
    yield found(ERROR, "misspelt-name", sentence, python.source, start, mend)


WHY: Final = {
    "python-broken": {
        "en": "Python reads a file whole before it runs any of it: the node does not start.",
        "de": "Python liest eine Datei ganz, bevor etwas läuft: Die Node startet nicht.",
    },
    "type-of-other-package": {
        "en": "Each type belongs to one package; the import fails, and the node does not start.",
        "de": "Jeder Typ gehört zu einem Paket; der Import scheitert, die Node startet nicht.",
    },
    "type-unknown": {
        "en": "The import fails, and the node does not start.",
        "de": "Der Import scheitert, und die Node startet nicht.",
    },
    "name-not-imported": {
        "en": "Python stops with a NameError when it comes to this line.",
        "de": "Python bricht an dieser Zeile mit NameError ab.",
    },
    "name-unknown": {
        "en": "Python stops with a NameError when it comes to this line.",
        "de": "Python bricht an dieser Zeile mit NameError ab.",
    },
    "misspelt-name": {
        "en": "Python stops with an AttributeError when it comes to this line.",
        "de": "Python bricht an dieser Zeile mit AttributeError ab.",
    },
    "no-such-method": {
        "en": "Python stops with an AttributeError: action servers are objects of their own.",
        "de": "Python bricht mit AttributeError ab: Action-Server sind eigene Objekte.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
