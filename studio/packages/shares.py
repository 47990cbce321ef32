"""What a build installs of a package, and its folder `share/PACKAGE` without a build."""

from __future__ import annotations

import os
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.files import is_file
from studio.packages.roots import is_below
from studio.packages.sources.package_source import PackageSource

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

_LINKS_MAX: Final = 5_000
_USUAL: Final = ("config", "launch", "meshes", "params", "rviz", "urdf", "worlds")
_COMPUTING: Final = frozenset({"ament_auto_package", "install_launch_files", "foreach", "file"})
"""Commands of CMake that may install more than is written out."""


def share_of(folder: Path, package: str, links: Callable[[], Path]) -> Path:
    """Return the folder of a package's shared files.

    It is the package's own folder where files install to where they lie. Where they do not, as
    those of `glob('urdf/*')` right into the share folder, it is a folder of links.

    Args:
        folder: That of the package's sources, or its share folder.
        package: Its name.
        links: Gives a folder, the same each time, for folders of links.
    """
    if folder.parent.name == "share":
        return folder
    moved = [(to, source) for to, source in installed_files(folder, package) if to != source]
    moved = [(to, source) for to, source in moved if _is_inside(folder, source)][:_LINKS_MAX]
    if all((folder / to).exists() for to, _ in moved):
        return folder
    share = links() / package / "share" / package
    if share.exists():
        return share
    share.mkdir(parents=True)
    for entry in sorted(folder.iterdir()):
        (share / entry.name).symlink_to(entry)
    for to, source in moved:
        _link(share, to, folder / source)
    return share


@dataclass(frozen=True, slots=True)
class _Rule:
    """Something that is installed: a file, a pattern of files, or a folder with all in it."""

    what: str
    """Below the package; a folder's ends with `/` where it is what is in it that is installed."""
    is_folder: bool
    destinations: tuple[str, ...]
    """Below the prefix: `share/my_package`; none: it is computed."""


def left_out(source: PackageSource, names: Iterable[str]) -> list[str]:
    """Return the files that the build does not install; none where that is computed."""
    if _is_computed(source):
        return []
    rules = tuple(_rules(source))
    return [one for one in names if not any(_matches(rule, one) for rule in rules)]


def installed_files(folder: Path, package: str) -> list[tuple[str, str]]:
    """Return where a package's files install: (path below share/PACKAGE, path below its folder).

    Of a package without build files it is where such files install in most packages.
    """
    source = PackageSource(folder, name=package)
    base = f"share/{package}"
    found: list[tuple[str, str]] = []
    for rule in _rules(source):
        for destination in rule.destinations:
            if destination == base or destination.startswith(f"{base}/"):
                below = destination[len(base) :].strip("/")
                found += _placed(folder, rule, below)
    if not any(is_file(folder / name) for name in ("setup.py", "CMakeLists.txt")):
        found += _guessed(folder)
    return found


def _rules(source: PackageSource) -> Iterator[_Rule]:
    for row in source.setup.data_files if source.setup else ():
        named = () if row.destination is None else (os.path.normpath(row.destination).strip("/"),)
        yield from (_Rule(one, is_folder=False, destinations=named) for one in row.sources)
    lists = source.cmake
    for kind, name, call in lists.installs() if lists else ():
        if lists is not None and kind != "TARGETS":
            yield _Rule(name, kind == "DIRECTORY", lists.destinations(call))


def _matches(rule: _Rule, name: str) -> bool:
    pattern = rule.what.removeprefix("./")
    if rule.is_folder:
        folder = pattern.rstrip("/")
        return folder in {"", "."} or name.startswith(f"{folder}/")
    if "/" in pattern and pattern.count("/") != name.count("/") and "**" not in pattern:
        return False
    return fnmatchcase(name, pattern)


def _is_computed(source: PackageSource) -> bool:
    setup, lists = source.setup, source.cmake
    if setup is not None and (
        setup.computes_data_files or any(not one.is_whole for one in setup.data_files)
    ):
        return True
    return lists is not None and any(
        one.name in _COMPUTING or (one.name == "install" and "${" in "".join(one.values[:2]))
        for one in lists.calls
    )


def _placed(folder: Path, rule: _Rule, below: str) -> Iterator[tuple[str, str]]:
    """Yield the files of a rule with where they install below the share folder."""
    steps = Path(os.path.normpath(rule.what)).parts
    if not steps or ".." in steps or Path(rule.what).is_absolute():
        return
    if rule.is_folder:
        inner = "" if rule.what.endswith("/") else Path(rule.what).name
        yield from _files_below(folder, rule.what.rstrip("/"), _join(below, inner).rstrip("/"))
        return
    has_wildcard = any(letter in rule.what for letter in "*?[")
    for name in _matching(folder, rule.what) if has_wildcard else (rule.what,):
        yield _join(below, Path(name).name), name


def _matching(folder: Path, pattern: str) -> list[str]:
    """Return the files of a pattern in the package, sorted, at most so many as are linked."""
    found: list[str] = []
    try:
        for path in folder.glob(os.path.normpath(pattern)):
            found.append(path.relative_to(folder).as_posix())
            if len(found) >= _LINKS_MAX:
                break
    except (OSError, ValueError, NotImplementedError):
        pass
    return sorted(found)


def _guessed(folder: Path) -> Iterator[tuple[str, str]]:
    """Yield the usual folders one level down: `x/urdf/` as `urdf/`."""
    for part in sorted(one for one in folder.iterdir() if one.is_dir()):
        for name in _USUAL:
            if (part / name).is_dir() and not (folder / name).exists():
                yield from _files_below(folder, f"{part.name}/{name}", name)


def _join(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder else name


def _files_below(folder: Path, name: str, below: str) -> Iterator[tuple[str, str]]:
    top = folder / name
    count = 0
    for path, folders, files in os.walk(top):
        folders.sort()
        for file in sorted(files):
            count += 1
            if count > _LINKS_MAX:
                return
            relative = Path(path, file).relative_to(top).as_posix()
            yield _join(below, relative), _join(name, relative)


def _is_inside(folder: Path, source: str) -> bool:
    real = Path(os.path.realpath(folder / source))
    return real.is_file() and is_below(real, Path(os.path.realpath(folder)))


def _link(share: Path, to: str, source: Path) -> None:
    *steps, name = to.split("/")
    if ".." in steps or name in ("", ".", ".."):
        return
    at = share
    for step in steps:
        at = at / step
        if at.is_symlink() and at.is_dir():
            real = Path(os.path.realpath(at))
            at.unlink()
            at.mkdir()
            for entry in real.iterdir():
                (at / entry.name).symlink_to(entry)
        elif not at.exists():
            at.mkdir()
        elif not at.is_dir():
            return
    if not (at / name).exists():
        (at / name).symlink_to(source)
