"""ament_index_python: packages and their folders, those of the workspace without a build."""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from studio.packages.passing import passed_packages
from studio.packages.shares import share_of

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

_PREFIXES = "AMENT_PREFIX_PATH"
_INDEX = Path("share", "ament_index", "resource_index")
_PACKAGES = "packages"


_PACKAGES_OF_SOURCES: list[Callable[[], Mapping[str, Path]]] = []
_LINKS: list[Callable[[], Path]] = []


def use_packages(packages: Callable[[], Mapping[str, Path]], links: Callable[[], Path]) -> None:
    """Have this process know these packages of sources, instead of those passed on to it.

    Args:
        packages: Gives their folders by name.
        links: Gives the folder for folders of links.
    """
    _PACKAGES_OF_SOURCES[:], _LINKS[:] = [cache(packages)], [links]


def _own_packages() -> Mapping[str, Path]:
    return _PACKAGES_OF_SOURCES[0]() if _PACKAGES_OF_SOURCES else passed_packages()


class PackageNotFoundError(KeyError):
    """No package of that name is known."""

    __module__ = "ament_index_python.packages"

    def __str__(self) -> str:
        return f"package '{self.args[0]}' not found, searching: {get_search_paths(checked=False)}"


class InvalidResourceTypeNameError(ValueError):
    """A type of resources has a name that none may have."""


class InvalidResourceNameError(ValueError):
    """A resource has a name that none may have."""


def get_search_paths(*, checked: bool = True) -> list[str]:
    """Return the prefixes of AMENT_PREFIX_PATH that exist.

    Raises:
        LookupError: The variable is empty, and no package of a workspace is known.
    """
    named = [one for one in os.environ.get(_PREFIXES, "").split(os.pathsep) if one]
    if not named and checked and not _own_packages():
        raise LookupError(f"Environment variable '{_PREFIXES}' is not set or empty")
    return [one for one in named if Path(one).is_dir()]


def get_package_prefix(package_name: str) -> str:
    """Return the folder that `share/PACKAGE` is in.

    Raises:
        PackageNotFoundError: The package is not known.
        ValueError: It is no name of a package.
    """
    if not package_name or set(package_name) & set("/\\\0"):
        raise ValueError(f"'{package_name}' is not a valid package name")
    folder = _own_packages().get(package_name)
    if folder is not None:
        return str(_prefix_of(package_name, folder))
    for prefix in get_search_paths(checked=False):
        if (Path(prefix) / _INDEX / _PACKAGES / package_name).is_file():
            return prefix
    raise PackageNotFoundError(package_name)


def get_package_share_directory(package_name: str, print_warning: bool = True) -> str:  # noqa: FBT001, FBT002
    """Return the folder of a package's shared files.

    That of a package of sources is its own folder, or one of links where its files install
    elsewhere.

    Raises:
        PackageNotFoundError: The package is not known.
    """
    del print_warning
    folder = _own_packages().get(package_name)
    if folder is not None:
        return str(share_of(folder, package_name, _links))
    return str(Path(get_package_prefix(package_name)) / "share" / package_name)


def get_package_share_path(package_name: str, print_warning: bool = True) -> Path:  # noqa: FBT001, FBT002
    """Return the folder of a package's shared files, as a Path.

    Raises:
        PackageNotFoundError: The package is not known.
    """
    return Path(get_package_share_directory(package_name, print_warning))


def get_packages_with_prefixes() -> dict[str, str]:
    """Return all packages with their prefixes."""
    return get_resources(_PACKAGES)


def get_resources(resource_type: str) -> dict[str, str]:
    """Return the resources of a type, by name, with the prefix of each.

    Raises:
        InvalidResourceTypeNameError: The type's name is empty, or holds a slash.
    """
    _check(resource_type, InvalidResourceTypeNameError)
    found: dict[str, str] = {}
    for prefix in get_search_paths(checked=False):
        folder = Path(prefix) / _INDEX / resource_type
        if folder.is_dir():
            for one in sorted(folder.iterdir()):
                if one.is_file() and not one.name.startswith("."):
                    found.setdefault(one.name, prefix)
    if resource_type == _PACKAGES:
        found |= {name: get_package_prefix(name) for name in _own_packages()}
    return found


def get_resource_types() -> set[str]:
    """Return the types of which there are resources."""
    folders = (Path(prefix) / _INDEX for prefix in get_search_paths(checked=False))
    found = {one.name for folder in folders if folder.is_dir() for one in folder.iterdir()}
    return found | {_PACKAGES} if _own_packages() else found


def has_resource(resource_type: str, resource_name: str) -> str | bool:
    """Return the prefix of a resource; False where there is none.

    Raises:
        InvalidResourceTypeNameError: The type's name is empty, or holds a slash.
        InvalidResourceNameError: So does the resource's.
    """
    _check(resource_name, InvalidResourceNameError)
    return get_resources(resource_type).get(resource_name, False)


def get_resource(resource_type: str, resource_name: str) -> tuple[str, str]:
    """Return the text of a resource, and its prefix.

    Raises:
        LookupError: There is none.
        OSError: It cannot be read.
    """
    prefix = has_resource(resource_type, resource_name)
    if isinstance(prefix, bool):
        raise LookupError(  # noqa: TRY004 - what ament_index_python raises
            f"Could not find the resource '{resource_name}' of type '{resource_type}'"
        )
    if resource_type == _PACKAGES and resource_name in _own_packages():
        return "", prefix  # as a build writes it
    path = Path(prefix) / _INDEX / resource_type / resource_name
    return path.read_text(encoding="utf-8"), prefix


def _check(name: str, error: type[ValueError]) -> None:
    if not name or "/" in name or name in {".", ".."}:
        raise error(f"'{name}' is not a valid name")


def _prefix_of(package: str, folder: Path) -> Path:
    """Return a folder with `share/PACKAGE` for a package of sources."""
    share = Path(get_package_share_directory(package))
    if share.parent.name == "share":
        return share.parent.parent
    prefix = _links() / package
    link = prefix / "share" / package
    if not link.exists():
        link.parent.mkdir(parents=True, exist_ok=True)
        link.symlink_to(folder)
    return prefix


@cache
def _links() -> Path:
    """Give a folder for folders of links; one made here is removed when the process ends."""
    if _LINKS:
        return _LINKS[0]()
    folder = Path(tempfile.mkdtemp(prefix="studio-share-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder
