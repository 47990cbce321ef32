"""`studio pkg list`, `xml`, `executables`, `prefix`: the packages of opened folders."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.packages import add_package_options, opened_packages
from studio.cli.wire import take_wire_options
from studio.errors import PackageNotFoundError
from studio.packages.manifest import FILE_NAME, SIZE_LIMIT_BYTES
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    import argparse

    from studio.cli.verbs import Verbs
    from studio.packages.index import PackageIndex


def add(verbs: Verbs) -> None:
    """Add the verbs that print what is known of packages."""
    _add_common(verbs.add("list", _list, "name the packages of opened folders"))
    xml = verbs.add("xml", _xml, "print the package.xml of a package")
    xml.add_argument("package_name", metavar="PACKAGE")
    xml.add_argument("-t", "--tag", help="only what stands in this tag")
    _add_common(xml)
    executables = verbs.add("executables", _executables, "name what packages start")
    executables.add_argument("package_name", metavar="PACKAGE", nargs="?")
    executables.add_argument(
        "--full-path", action="store_true", help="print the file that each is in"
    )
    _add_common(executables)
    prefix = verbs.add("prefix", _prefix, "print the folder of a package")
    prefix.add_argument("package_name", metavar="PACKAGE")
    _add_common(prefix)


def _add_common(parser: argparse.ArgumentParser) -> None:
    add_package_options(parser)
    take_wire_options(parser)


def _list(options: argparse.Namespace) -> None:
    from studio.programs.own import own_executables

    print(*sorted(opened_packages(options).names | set(own_executables())), sep="\n")


def _xml(options: argparse.Namespace) -> int:
    text = _manifest(opened_packages(options), options.package_name)
    if options.tag is None:
        print(text, end="" if text.endswith("\n") else "\n")
        return 0
    return _print_tag(text, options.tag)


def _manifest(index: PackageIndex, name: str) -> str:
    """Return the text of a package.xml; one is made for a package of our demos."""
    from studio.programs.own import own_manifest

    if name not in index and (written := own_manifest(name)):
        return written
    folder = _folder(index, name)
    return ServedRoots([folder]).read(folder / FILE_NAME, SIZE_LIMIT_BYTES).decode(errors="replace")


def _print_tag(text: str, tag: str) -> int:
    from studio.packages.manifest import texts_of_tag

    found = texts_of_tag(text.encode(), tag)
    print(*found, sep="\n" if found else "")
    return 0 if found else 1


def _executables(options: argparse.Namespace) -> int:
    from studio.programs.finding import executables_of_all

    index = opened_packages(options)
    found = executables_of_all(index)
    if options.package_name is not None:
        if options.package_name not in found and options.package_name not in index:
            raise PackageNotFoundError(options.package_name, str(Path.cwd()))
        found = {options.package_name: found.get(options.package_name, {})}
    for package, executables in sorted(found.items()):
        for name, place in sorted(executables.items()):
            print(place if options.full_path else f"{package} {name}")
    return 0


def _prefix(options: argparse.Namespace) -> None:
    from studio.programs.own import own_executables, own_folder

    index = opened_packages(options)
    if options.package_name not in index and options.package_name in own_executables():
        print(own_folder(options.package_name))
    else:
        print(_folder(index, options.package_name))


def _folder(index: PackageIndex, name: str) -> Path:
    return index.best(name, Path.cwd())
