"""What keeps the entries of `console_scripts` from starting: found here, told by `lint.entries`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.sources.package_source import PackageSource
    from studio.packages.sources.scripts import Script

CONFIG_OPTIONS: Final = (("develop", "script_dir"), ("install", "install_scripts"))
"""Options of setup.cfg that say where executables are put, with their sections."""
_DOTTED: Final = re.compile(r"[^\W\d]\w*(\.[^\W\d]\w*)*")
_TWO_IN_ONE: Final = re.compile(r"\S\s*=\s*[\w.]+:\w+\s*[,;]?\s+\S+\s*=")


@dataclass(frozen=True, slots=True)
class EntryFault:
    """One fault, by the code of its finding.

    Attributes:
        script: The entry; None: it is one of the package, which hides every entry.
        file: The file of the package that it is about, where there is one.
        option: Section and name in setup.cfg.
    """

    code: str
    script: Script | None = None
    file: str = ""
    option: tuple[str, str] = ("", "")


def faults_of(source: PackageSource, name: str) -> Iterator[EntryFault]:
    """Yield what keeps `ros2 run` from starting an executable, or hides its entry."""
    yield from build_faults(source)
    script = source.script(name)
    if script is not None:
        yield from stopping_faults(source, script)
        return
    for one in source.scripts:
        if not one.name or name in one.text:
            yield from form_faults(one)


def stopping_faults(source: PackageSource, script: Script) -> Iterator[EntryFault]:
    """Yield what keeps `ros2 run` from starting an entry of a package that is built."""
    yield from script_faults(source, script)
    yield from config_faults(source)


def build_faults(source: PackageSource) -> Iterator[EntryFault]:
    """Yield why setuptools builds nothing of the package."""
    setup = source.setup
    if setup is not None and setup.fault:
        yield EntryFault("setup-broken")
    elif setup is not None and setup.call is None:
        yield EntryFault("setup-call")


def script_faults(source: PackageSource, script: Script) -> Iterator[EntryFault]:
    """Follow an entry to its function, and yield the first fault on the way."""
    malformed = next(form_faults(script), None)
    if malformed is not None:
        yield malformed
        return
    found = source.module(script.module)
    if found is None:
        yield EntryFault("entry-module-missing", script)
        return
    root, file = found
    yield from _package_faults(source, script, root)
    python = source.python(file)
    if python is not None and not python.may_have(script.function.partition(".")[0]):
        yield EntryFault("entry-function-missing", script, file)


def form_faults(script: Script) -> Iterator[EntryFault]:
    """Yield how an entry is not `name = module:function`."""
    if _TWO_IN_ONE.search(script.text):
        yield EntryFault("entry-two-in-one", script)
        return
    words = (script.module, script.function)
    is_one = script.text.count("=") == 1 and script.name
    if not is_one or not all(_DOTTED.fullmatch(word) for word in words):
        yield EntryFault("entry-form", script)


def _package_faults(source: PackageSource, script: Script, root: str) -> Iterator[EntryFault]:
    """Yield why the folder of the module is not installed."""
    setup, folder = source.setup, script.module.rpartition(".")[0]
    if setup is None or not folder:
        return
    listed = setup.packages
    if listed is not None and folder not in listed:
        yield EntryFault("package-not-listed", script)
    elif setup.finds_packages:
        init = f"{folder.replace('.', '/')}/__init__.py"
        file = f"{root}/{init}" if root else init
        if not source.has(file):
            yield EntryFault("init-missing", script, file)


def config_faults(source: PackageSource) -> Iterator[EntryFault]:
    """Yield how setup.cfg has the executables put where `ros2 run` does not look."""
    config = source.config
    if source.setup is None or (config is None and not source.scripts):
        return
    if config is None:
        yield EntryFault("setup-cfg-missing")
        return
    for section, name in CONFIG_OPTIONS:
        option = config.option(section, name)
        if option is None or option.value.rstrip("/") != scripts_folder(source):
            yield EntryFault("setup-cfg-folder", option=(section, name))


def scripts_folder(source: PackageSource) -> str:
    """Return where `ros2 run` looks for the executables of a package, as setup.cfg names it."""
    return f"$base/lib/{source.name}"
