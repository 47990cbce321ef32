"""What can be started: the demo nodes under the course's names, and opened packages' own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

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
    from studio.nodes.demos.table import executables

    found: dict[str, dict[str, str]] = {}
    for (package, name), module in executables().items():
        found.setdefault(package, {})[name] = module
    return found
