"""Which packages a Python file needs by its imports, as package.xml would name them."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from studio.packages.ros_packages import ALSO, PYTHON_MODULES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from studio.packages.sources.python_file import Import, PythonFile


def needed_packages(
    python: PythonFile, own: str, has_package: Callable[[str], bool]
) -> Iterator[tuple[str, str, Import]]:
    """Yield (tag, package, import) for each package that is imported, once.

    Modules that nobody knows are left out: they may come by pip.

    Args:
        python: The file.
        own: The package that it is of.
        has_package: Whether ROS or the workspace has a package.
    """
    seen: set[str] = set()
    for one in python.imports:
        module = one.package
        if not module or module in seen or module == own or module in sys.stdlib_module_names:
            continue
        seen.add(module)
        if has_package(module):
            yield "depend", module, one
        elif module in PYTHON_MODULES:
            yield "exec_depend", PYTHON_MODULES[module], one


def satisfying(module: str, package: str) -> frozenset[str]:
    """Return the dependencies that bring a module, the one that would be added among them."""
    return ALSO.get(module, frozenset()) | {package, module}
