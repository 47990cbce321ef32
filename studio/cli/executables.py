"""What can be started: the demo nodes under the course's names, and opened packages' own."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from typing import TYPE_CHECKING

import studio
from studio.packages.environment import is_workspace_install
from studio.packages.executables import executables_of
from studio.packages.index import Standing

if TYPE_CHECKING:
    from studio.packages.index import PackageIndex


def executables_of_all(index: PackageIndex) -> dict[str, dict[str, str]]:
    """Give by package and name the file or module of all that can be started."""
    found = demo_executables()
    for name in index.names:
        own = executables_of(index.best(name, Path.cwd()), name)
        if workspace_folder(index, name) is not None:
            found.pop(name, None)
        if own:
            found[name] = {**own, **found.get(name, {})}
    return found


def workspace_folder(index: PackageIndex, name: str) -> Path | None:
    """Give the folder of a package that the user's workspace holds: it comes before a demo's.

    None where the name is unknown, or known only of a ROS that was installed as a whole.
    """
    if name not in index:
        return None
    folder = index.best(name, Path.cwd())
    standings = [one.standing for one in index.packages if one.folder == folder]
    is_source = any(standing is not Standing.INSTALLED for standing in standings)
    return folder if is_source or is_workspace_install(folder) else None


def demo_packages() -> set[str]:
    """Name the packages whose nodes the studio itself has."""
    return set(demo_executables())


def demo_executables() -> dict[str, dict[str, str]]:
    """Give the modules of the studio's own nodes by package and executable."""
    from studio.course.demos import executables

    found: dict[str, dict[str, str]] = {}
    for (package, name), module in executables().items():
        found.setdefault(package, {})[name] = module
    return found


def demo_folder(package: str) -> Path:
    """Give the folder that holds the code of a package of demos, which is one of the studio's."""
    module = next(iter(demo_executables()[package].values()))
    found = importlib.util.find_spec(module.rpartition(".")[0])
    return Path(next(iter((found and found.submodule_search_locations) or [""])))


def demo_manifest(package: str) -> str:
    """Write the package.xml that a package of demos would have; empty for any other."""
    names = ", ".join(sorted(demo_executables().get(package, {})))
    if not names:
        return ""
    return (
        '<?xml version="1.0"?>\n'
        "<!-- Written by the studio: these nodes come with it, in no package of their own. -->\n"
        '<package format="3">\n'
        f"  <name>{package}</name>\n"
        f"  <version>{studio.__version__}</version>\n"
        f"  <description>Demo nodes of the studio: {names}.</description>\n"
        '  <maintainer email="none@invalid">the studio</maintainer>\n'
        "  <license>Apache-2.0</license>\n"
        "</package>\n"
    )
