"""Checks of what a package depends on: said for all that it uses, and known by its name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.packages.edits import manifest_edits
from studio.packages.edits.imports_needed import needed_packages, satisfying
from studio.packages.lint.checked import INFO, WARNING, edit, found, meant, safely
from studio.packages.ros_packages import PACKAGES, is_system_key
from studio.packages.sources.interfaces import PACKAGE_NEEDS, interface_files, packages_of_interface

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.problems import Problem

_LETTERS_OFF_MAX: Final = 2
"""A name that is longer by more means another package."""
_WHY_NEEDED: Final = {
    "buildtool_depend": "which makes code of interfaces",
    "exec_depend": "which is needed to use them",
    "member_of_group": "the group to which every package of interfaces belongs",
}


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield imports that package.xml does not name, and names that nobody knows."""
    manifest = checked.source.manifest
    if not manifest.source.data:
        return
    yield from _unknown(checked)
    if not manifest.fault:
        yield from _imported(checked)
        yield from _of_interfaces(checked)


def _unknown(checked: CheckedPackage) -> Iterator[Problem]:
    manifest = checked.source.manifest
    names = {*PACKAGES, *checked.packages, *checked.known.installed}
    for one in manifest.dependencies():
        name = one.text
        if not name or not name.replace("_", "").replace("-", "").isalnum():
            continue
        if checked.has_package(name) or is_system_key(name):
            if name == checked.source.name:
                sentence = f"{name} depends on itself: take the line out."
                mend = edit("Remove it", manifest.source.without_lines(one.start, one.end))
                yield found(
                    WARNING, "depends-on-itself", sentence, manifest.source, one.start, mend
                )
            continue
        right = meant(name, names, 0.85)
        if right and abs(len(right) - len(name)) <= _LETTERS_OFF_MAX:
            change = manifest.source.replaced(one.inner_start, one.inner_end, right)
            sentence = f'No package "{name}" is known: {right} is meant, it seems.'
            mend = edit(f"Write {right}", change)
            yield found(WARNING, "unknown-package", sentence, manifest.source, one.start, mend)
        else:
            sentence = (
                f'The package "{name}" is neither in this workspace nor one that the studio knows: '
                "rosdep has to find it."
            )
            yield found(INFO, "unlisted-package", sentence, manifest.source, one.start)


def _imported(checked: CheckedPackage) -> Iterator[Problem]:
    manifest = checked.source.manifest
    named = {one.text for one in manifest.dependencies()}
    said: set[str] = set()
    own = {one.partition("/")[0] for one in checked.source.below("", "/__init__.py")}
    for python in checked.python_files:
        needed = needed_packages(python, checked.source.name, checked.has_package)
        for tag, package, one in needed:
            module = one.package
            if module in own or package in said or satisfying(module, package) & named:
                continue
            said.add(package)
            sentence = (
                f'"{module}" is imported, and package.xml does not name {package}: '
                f"<{tag}>{package}</{tag}> belongs there."
            )
            mend = safely(
                "Add it to package.xml",
                lambda tag=tag, package=package: manifest_edits.added(manifest, tag, package),
            )
            at = python.span(one.alias)[0]
            yield found(WARNING, "missing-depend", sentence, python.source, at, mend)


def _of_interfaces(checked: CheckedPackage) -> Iterator[Problem]:
    source = checked.source
    named = {one.text for one in source.manifest.dependencies()}
    files = interface_files(source)
    if not files or source.is_python:
        return
    for tag, name in PACKAGE_NEEDS:
        if name not in named and name not in source.manifest.groups():
            yield _lacks(checked, tag, name, f"{name}, {_WHY_NEEDED[tag]}")
    for kind, name in files:
        text = source.text(name)
        for package in packages_of_interface(text.text, kind, source.name) if text else ():
            # rosidl_default_generators brings action_msgs by itself.
            by_hand = package not in named and package != "action_msgs"
            if by_hand and checked.has_package(package):
                named.add(package)
                yield _lacks(checked, "depend", package, f"{package}, of which {name} uses types")


def _lacks(checked: CheckedPackage, tag: str, name: str, what: str) -> Problem:
    manifest = checked.source.manifest
    mend = safely("Add it to package.xml", lambda: manifest_edits.added(manifest, tag, name))
    sentence = f"package.xml does not name {what}: add <{tag}>{name}</{tag}>."
    return found(WARNING, "missing-interface-depend", sentence, manifest.source, 0, mend)


WHY: Final = {
    "unknown-package": {
        "en": "rosdep finds no package of that name, and the build stops in CMake.",
        "de": "rosdep findet kein Paket dieses Namens, und der Bau bricht in CMake ab.",
    },
    "unlisted-package": {
        "en": "It may well exist: the studio knows the packages that courses and robots use most.",
        "de": "Vielleicht gibt es das Paket: Das Studio kennt nur die gebräuchlichsten.",
    },
    "depends-on-itself": {
        "en": "colcon would have to build the package before itself.",
        "de": "colcon müsste das Paket vor sich selbst bauen.",
    },
    "missing-depend": {
        "en": "It runs where the package happens to be installed, and fails elsewhere: colcon and "
        "rosdep know only what package.xml names.",
        "de": "Es läuft, wo das Paket zufällig installiert ist, und sonst nicht: colcon und rosdep "
        "kennen nur, was package.xml nennt.",
    },
    "missing-interface-depend": {
        "en": "Code for messages, services and actions is only made with these entries.",
        "de": "Code für Nachrichten, Services und Actions entsteht nur mit diesen Einträgen.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
