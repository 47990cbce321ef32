"""The edits that make a package, or add something to one; imported when the first is asked for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.live.programs.inspecting import what_is_known
from studio.packages.creation.new_package import NewPackage
from studio.packages.edits.new_files import (
    InterfaceKind,
    new_interface,
    new_launch_file,
    new_node,
)
from studio.packages.edits.new_packages import (
    new_description_package,
    new_package,
)
from studio.packages.executables import executables
from studio.packages.sources.package_source import PackageSource

if TYPE_CHECKING:
    from studio.packages.edits.package_edit import PackageEdit
    from studio.protocol.workspaces import AddToPackage, CreatePackage

_KINDS: Final[dict[str, InterfaceKind]] = {"message": "msg", "service": "srv", "action": "action"}


def edit_of_new(folder: Path, command: CreatePackage) -> PackageEdit:
    """Return the edit that makes a package."""
    if command.contents == "description":
        return new_description_package(folder, command.name)
    is_interfaces = command.contents == "interfaces"
    given = {
        name: value
        for name in ("license", "description", "maintainer_name", "maintainer_email")
        if (value := getattr(command, name))
    }
    new = NewPackage(
        command.name,
        "ament_cmake" if is_interfaces else command.build_type,
        command.dependencies,
        command.node_name,
        command.library_name,
        has_interfaces=is_interfaces,
        **given,
    )
    edit = new_package(folder, new)
    node = (one.file for one in edit.new_files if Path(one.file).stem == command.node_name)
    return replace(edit, opened=next(node, edit.opened))


def edit_of_addition(folder: Path, command: AddToPackage) -> PackageEdit:
    """Return the edit that adds something to a package."""
    source, known = PackageSource(folder), what_is_known()
    match command.what:
        case "node":
            return new_node(source, command.name, command.template, known)
        case "launch_file":
            nodes = [(source.name, one.name) for one in executables(source)]
            return new_launch_file(source, command.name, nodes=nodes)
        case _:
            return new_interface(source, _KINDS[command.what], command.name, command.text, known)
