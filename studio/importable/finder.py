"""Finder: makes the modules that a user's ROS 2 code imports; a real one always wins."""

from __future__ import annotations

import importlib
import sys
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import spec_from_file_location
from typing import TYPE_CHECKING, Any, Final

from studio.importable.names import MODULES, ON_IMPORT, PACKAGES
from studio.ros.messages import spec_of_types

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import ModuleType

    from studio.importable.workspace import Workspace

README: Final = 'the README says what is, under "Your own code"'


class RosFinder(MetaPathFinder):
    """Finds modules of ROS, message packages, and the Python packages of the workspace."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Find what no other finder finds.

        A folder without `__init__.py` is none of Python's packages here: the folder of a package
        of ROS in the current one would hide the package.

        Raises:
            ModuleNotFoundError: It is below a package of ROS that is here, and is not here itself.
        """
        elsewhere = self._elsewhere(fullname, path, target)
        if elsewhere is not None and elsewhere.origin is not None:
            return None
        if fullname in MODULES:
            return ModuleSpec(fullname, _NamesLoader(), is_package=fullname in PACKAGES)
        top, dot, rest = fullname.partition(".")
        if top in MODULES and dot:
            raise ModuleNotFoundError(missing_sentence(fullname), name=fullname)
        if rest in {"", "msg", "srv", "action"}:
            self._workspace.take_types(top)
            if (spec := spec_of_types(fullname, top, rest)) is not None:
                return _with_folders(spec, elsewhere)
        if not dot and (file := self._workspace.python_package(top)) is not None:
            folders = [str(file.parent)] if file.name == "__init__.py" else None
            return spec_from_file_location(fullname, file, submodule_search_locations=folders)
        return None

    def _elsewhere(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None
    ) -> ModuleSpec | None:
        """Return what another finder finds: a module, else a folder, which has no origin."""
        folder: ModuleSpec | None = None
        for finder in sys.meta_path:
            if finder is not self and hasattr(finder, "find_spec"):
                found = finder.find_spec(fullname, path, target)
                if found is not None and found.origin is not None:
                    return found
                folder = folder or found
        return folder


def _with_folders(spec: ModuleSpec, folder: ModuleSpec | None) -> ModuleSpec:
    """Let modules be found in a folder, too, that has the name of a package of types."""
    locations = spec.submodule_search_locations
    if folder is not None and locations is not None:
        locations.extend(folder.submodule_search_locations or ())
    return spec


def missing_sentence(name: str) -> str:
    """Return what is said of a name that real modules have and ours do not."""
    return f"not in the studio's {name.partition('.')[0]}: {name}; {README}"


class _NamesLoader(Loader):
    """Makes a module whose names are imported from the studio when they are asked for."""

    def exec_module(self, module: ModuleType) -> None:
        name = module.__name__
        names = MODULES[name]
        module.__doc__ = f"{name} as the studio has it."

        def get(wanted: str) -> Any:  # noqa: ANN401
            if wanted in names:
                found = _fetch(names[wanted])
                setattr(module, wanted, found)
                return found
            if f"{name}.{wanted}" in MODULES:
                return importlib.import_module(f"{name}.{wanted}")
            if wanted.startswith("__"):
                raise AttributeError(f"module {name!r} has no attribute {wanted!r}")
            raise AttributeError(missing_sentence(f"{name}.{wanted}"), name=wanted, obj=module)

        def listed() -> list[str]:
            return sorted(names)

        if (first := ON_IMPORT.get(name)) is not None:
            _fetch(first)()
        vars(module).update(__getattr__=get, __dir__=listed, __all__=listed())


def _fetch(target: str) -> Any:  # noqa: ANN401
    """Import what a target names: `module:attribute`, or a module alone."""
    module, colon, attribute = target.partition(":")
    found: Any = importlib.import_module(module)
    return getattr(found, attribute) if colon else found


def install(workspace: Workspace) -> None:
    """Put the finder before that of folders, and let others come first; again is harmless."""
    if any(isinstance(finder, RosFinder) for finder in sys.meta_path):
        return
    places = [number for number, one in enumerate(sys.meta_path) if one is PathFinder]
    sys.meta_path.insert(places[0] if places else len(sys.meta_path), RosFinder(workspace))
