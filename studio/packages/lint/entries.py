"""Checks of the entries of `console_scripts`, from setup.py and setup.cfg to the function.

`studio run` refuses with the finding that is made here of what stops the executable.
"""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING, Final

from studio.packages.edits import setup_edits
from studio.packages.lint.checked import ERROR, WARNING, edit, found, meant, safely
from studio.packages.sources.entries import (
    build_faults,
    config_faults,
    script_faults,
    scripts_folder,
)
from studio.problems import NewFile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.entries import EntryFault
    from studio.packages.sources.package_source import PackageSource
    from studio.packages.sources.scripts import Script
    from studio.packages.sources.setup_py import SetupPy
    from studio.problems import Fix, Problem

_TWO: Final = re.compile(
    r"^\s*([\w.-]+)\s*=\s*([\w.]+:\w+)\s*[,;]?\s+([\w.-]+)\s*=\s*([\w.]+:\w+)\s*$"
)
_NAMED_MAX: Final = 8
"""Functions or modules that a sentence names."""


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield what keeps entries from starting, and entries that are not there."""
    source = checked.source
    setup = source.setup
    if setup is None or not source.is_python:
        return
    broken = [*build_faults(source)]
    if broken:
        yield from (problem_of(source, one) for one in broken)
        return
    said: set[tuple[str, str]] = set()
    names: set[str] = set()
    for one in source.scripts:
        folder = one.module.rpartition(".")[0]
        for fault in script_faults(source, one):
            if fault.code in _OF_FOLDERS and (fault.code, folder) in said:
                continue
            said.add((fault.code, folder))
            yield problem_of(source, fault)
        if one.name and one.name in names:
            sentence = f'Two entries are called "{one.name}": only one of them is started.'
            yield found(ERROR, "entry-repeated", sentence, one.source, one.start)
        names.add(one.name)
    has_main = any("main" in one.top_level_names for one in checked.python_files)
    if has_main and not source.scripts and setup.keyword("entry_points") is None:
        sentence = "setup.py has no entry_points: ros2 run finds nothing to start."
        at = setup.python.span(setup.call)[0] if setup.call else 0
        yield found(WARNING, "entry-points-missing", sentence, setup.source, at)
    yield from (problem_of(source, one) for one in config_faults(source))


def problem_of(source: PackageSource, fault: EntryFault) -> Problem:
    """Return the finding of a fault of these files, with its mend."""
    return _FINDINGS[fault.code](source, fault)


def _of_script(fault: EntryFault) -> Script:
    assert fault.script is not None
    return fault.script


def _of_setup(source: PackageSource) -> SetupPy:
    assert source.setup is not None
    return source.setup


def _broken(source: PackageSource, _: EntryFault) -> Problem:
    setup = _of_setup(source)
    line = setup.python.fault_line
    text = setup.source.text
    hint = " Mend it: until then nothing of the package is built or started."
    if re.search(r"never closed|EOF|unmatched|does not match|unterminated", setup.fault):
        hint = " Close every bracket that is opened: entry_points={'console_scripts': [...]},"
    if "console_scripts" in text and "data_files" in text and "forgot a comma" in setup.fault:
        hint = " Between data_files=[...] and entry_points={...} stands a comma."
    sentence = f"setup.py is no Python: {setup.fault.rstrip('?.')}.{hint}"
    return found(ERROR, "setup-broken", sentence, setup.source, setup.source.offset(line or 1))


def _not_called(source: PackageSource, _: EntryFault) -> Problem:
    sentence = "setup.py never calls setup(): nothing is built."
    return found(ERROR, "setup-call", sentence, _of_setup(source).source)


def _two_in_one(_: PackageSource, fault: EntryFault) -> Problem:
    one = _of_script(fault)
    mend = None
    if two := _TWO.match(one.text):
        rows = [f"{two[n]} = {two[n + 1]}" for n in (1, 3)]
        mend = edit("Make two entries of it", one.source.replaced(*_span(one), _rows(one, rows)))
    sentence = f'"{one.text}" holds two entries: each is a text of its own, with a comma between.'
    return found(ERROR, "entry-two-in-one", sentence, one.source, one.start, mend)


def _span(one: Script) -> tuple[int, int]:
    return one.start, one.end


def _rows(one: Script, entries: list[str]) -> str:
    """Write entries in the place of one: quoted in setup.py, each on a line in setup.cfg."""
    quote = one.source.slice(one.start, one.start + 1)
    if quote in {"'", '"'}:
        return ", ".join(f"{quote}{entry}{quote}" for entry in entries)
    indent = one.source.indent_at(one.start) or "    "
    return f"{one.source.line_break}{indent}".join(entries)


def _form(_: PackageSource, fault: EntryFault) -> Problem:
    one = _of_script(fault)
    mend = None
    if one.text.count("=") > 1:
        sentence = f'"{one.text}" has more than one "=": name = module:function is meant.'
        parts = [part.strip() for part in one.text.split("=")]
        if re.fullmatch(r"[\w.]+:\w+", parts[-1]):
            text = _rows(one, [f"{parts[0]} = {parts[-1]}"])
            mend = edit("Keep the first name", one.source.replaced(*_span(one), text))
    else:
        name, module = one.name or "name", one.module or "module"
        example = f", {name} = {module}:main, say" if re.fullmatch(r"[\w.]+", module) else ""
        sentence = f'"{one.text}" starts nothing: name = module:function is meant{example}.'
    return found(ERROR, "entry-form", sentence, one.source, one.start, mend)


def _module_missing(source: PackageSource, fault: EntryFault) -> Problem:
    one = _of_script(fault)
    module = one.module
    modules = {
        name.removesuffix(".py").replace("/", "."): name
        for name in source.below("", ".py")
        if "/" in name and not name.startswith(("test/", "launch/"))
    }
    right = _meant_module(module, modules)
    if right:
        hint = f"{right} is meant, it seems"
    else:
        hint = f"write {module.replace('.', '/')}.py"
        folder = module.rpartition(".")[0]
        there = sorted(
            name
            for name in modules
            if name.rpartition(".")[0] == folder and not name.endswith(".__init__")
        )
        hint += f", or name one that is there, {_listed(there)}" if there else ""
    sentence = f'"{one.name}" starts {module}, and no file of the package is that module: {hint}.'
    mend = _replaced(one, module, right) if right else None
    return found(ERROR, "entry-module-missing", sentence, one.source, one.start, mend)


def _listed(names: list[str]) -> str:
    return ", ".join(names[:_NAMED_MAX]) + (", ..." if len(names) > _NAMED_MAX else "")


def _meant_module(module: str, modules: Iterable[str]) -> str:
    """Return the only module of that name elsewhere, or one of a name like it."""
    folder, _, last = module.rpartition(".")
    same = [one for one in modules if one.rpartition(".")[2] == last]
    if len(same) == 1:
        return same[0]
    beside = [one.rpartition(".")[2] for one in modules if one.rpartition(".")[0] == folder]
    if beside:
        right = meant(last, beside, 0.6)
        return f"{folder}.{right}" if right else ""
    return meant(module, modules, 0.75)


def _function_missing(source: PackageSource, fault: EntryFault) -> Problem:
    one = _of_script(fault)
    python = source.python(fault.file)
    first = one.function.partition(".")[0]
    names = python.top_level_names if python else frozenset[str]()
    right = meant(first, names, 0.7)
    if right:
        hint = f"{right} is meant, it seems"
    else:
        functions = sorted(python.top_level_functions) if python else []
        hint = f"write def {first}(args=None): at the beginning of a line"
        hint += f", or start one that it has, {_listed(functions)}" if functions else ""
    sentence = f'"{one.name}" starts {first}() of {fault.file}, which has no such function: {hint}.'
    mend = _replaced(one, f":{first}", f":{right}") if right else None
    return found(ERROR, "entry-function-missing", sentence, one.source, one.start, mend)


def _replaced(one: Script, before: str, after: str) -> Fix | None:
    text = one.source.slice(one.start, one.end)
    if text.count(before) != 1:
        return None
    change = one.source.replaced(*_span(one), text.replace(before, after))
    return edit(f"Write {after.lstrip(':')}", change)


def _not_listed(source: PackageSource, fault: EntryFault) -> Problem:
    setup, node = _of_setup(source), _of_setup(source).keyword("packages")
    folder = _of_script(fault).module.rpartition(".")[0]
    sentence = f'packages does not list "{folder}", whose modules entry_points start.'
    quote = "'" if "'" in setup.source.text else '"'
    mend = None
    if isinstance(node, ast.List):
        listed = node
        mend = safely(
            f"List {folder}",
            lambda: [setup_edits.list_items_added(setup, listed, [f"{quote}{folder}{quote}"])],
        )
    at = setup.python.span(node)[0] if node else 0
    return found(ERROR, "package-not-listed", sentence, setup.source, at, mend)


def _init_missing(source: PackageSource, fault: EntryFault) -> Problem:
    one, folder = _of_script(fault), fault.file.rpartition("/")[0]
    mend = edit(f"Make {fault.file}", new_files=(NewFile(source.file(fault.file), ""),))
    sentence = f"The folder {folder} has no __init__.py: find_packages() passes over it."
    return found(ERROR, "init-missing", sentence, one.source, one.start, mend)


def _no_config(source: PackageSource, _: EntryFault) -> Problem:
    right = scripts_folder(source)
    whole = f"[develop]\nscript_dir={right}\n[install]\ninstall_scripts={right}\n"
    mend = edit("Make setup.cfg", new_files=(NewFile(source.file("setup.cfg"), whole),))
    sentence = f"There is no setup.cfg: the executables are not put where ros2 run looks, {right}."
    return found(ERROR, "setup-cfg-missing", sentence, _of_setup(source).source, 0, mend)


def _other_folder(source: PackageSource, fault: EntryFault) -> Problem:
    config, right = source.config, scripts_folder(source)
    assert config is not None
    section, key = fault.option
    option, text = config.option(section, key), config.source
    if option is not None and option.value:
        mend = edit(f"Write {right}", text.replaced(option.start, option.end, right))
        sentence = f"[{section}] {key} is {option.value}: ros2 run looks in {right}."
        return found(ERROR, "setup-cfg-folder", sentence, text, option.start, mend)
    mend = None
    if text.data:
        eol = text.line_break
        at = config.sections.get(section)
        line = f"{key}={right}{eol}" if at is not None else f"[{section}]{eol}{key}={right}{eol}"
        lead = "" if text.data.endswith(b"\n") or at not in (None, len(text.data)) else eol
        mend = edit(f"Set {key}", text.put_in(len(text.data) if at is None else at, lead + line))
    sentence = f"[{section}] sets no {key}: ros2 run looks in {right}."
    return found(ERROR, "setup-cfg-folder", sentence, text, 0, mend)


_OF_FOLDERS: Final = frozenset({"package-not-listed", "init-missing"})
"""Faults of the folder of a module: told once for all its modules."""
_FINDINGS: Final[dict[str, Callable[[PackageSource, EntryFault], Problem]]] = {
    "setup-broken": _broken,
    "setup-call": _not_called,
    "entry-two-in-one": _two_in_one,
    "entry-form": _form,
    "entry-module-missing": _module_missing,
    "entry-function-missing": _function_missing,
    "package-not-listed": _not_listed,
    "init-missing": _init_missing,
    "setup-cfg-missing": _no_config,
    "setup-cfg-folder": _other_folder,
}
WHY: Final = {
    "setup-broken": {
        "en": "colcon build stops with a traceback of Python.",
        "de": "colcon build bricht mit einem Traceback von Python ab.",
    },
    "setup-call": {
        "en": "setup() says what is built; without it nothing is.",
        "de": "setup() sagt, was gebaut wird; ohne den Aufruf geschieht nichts.",
    },
    "entry-repeated": {
        "en": "An executable is found by its name, so each name starts one thing.",
        "de": "Ein Programm wird über seinen Namen gefunden; jeder Name startet genau eines.",
    },
    "entry-points-missing": {
        "en": "ros2 run starts what console_scripts lists, not files.",
        "de": "ros2 run startet, was console_scripts nennt, keine Dateien.",
    },
    "entry-two-in-one": {
        "en": "Texts without a comma between them are one text, which starts neither.",
        "de": "Texte ohne Komma dazwischen sind ein Text: Der Bau bricht ab oder startet keinen.",
    },
    "entry-form": {
        "en": "setuptools refuses an entry of another form, and the build stops.",
        "de": "setuptools weist einen Eintrag anderer Form ab, und der Bau bricht ab.",
    },
    "entry-module-missing": {
        "en": "The package builds, and ros2 run fails with ModuleNotFoundError.",
        "de": "Das Paket lässt sich bauen, und ros2 run scheitert mit ModuleNotFoundError.",
    },
    "entry-function-missing": {
        "en": "The package builds, and ros2 run fails: the module has nothing of that name.",
        "de": "Das Paket lässt sich bauen, und ros2 run scheitert: Das Modul hat nichts dieses "
        "Namens.",
    },
    "package-not-listed": {
        "en": "Only modules of listed packages are installed; the others are not found.",
        "de": "Nur Module aufgezählter Pakete werden installiert; andere werden nicht gefunden.",
    },
    "init-missing": {
        "en": "A folder without __init__.py is no package for find_packages().",
        "de": "Ein Ordner ohne __init__.py ist für find_packages() kein Paket.",
    },
    "setup-cfg-missing": {
        "en": 'ros2 run says "No executable found", although the package was built.',
        "de": "ros2 run meldet „No executable found“, obwohl das Paket gebaut ist.",
    },
    "setup-cfg-folder": {
        "en": 'ros2 run says "No executable found", although the package was built.',
        "de": "ros2 run meldet „No executable found“, obwohl das Paket gebaut ist.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
