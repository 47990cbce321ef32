"""New packages beside others, as edits: around a robot's description, or any other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import NotMadeError
from studio.packages.creation.making import check_new, free_folder
from studio.packages.creation.package_texts import package_files
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.skeleton import description_files, name_fault, robot_of, template_text
from studio.problems import NewFile

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.creation.new_package import NewPackage
    from studio.packages.skeleton import Template


def new_package(folder: Path, new: NewPackage) -> PackageEdit:
    """Return the edit that makes a package in a folder.

    Raises:
        NotMadeError: Something forbids it, or bears its name there.
    """
    check_new(new)
    return _edit(folder, new.name, package_files(new), "package.xml")


def new_description_package(
    folder: Path, package: str, template: Template = "blank", text: bytes = b""
) -> PackageEdit:
    """Return the edit that makes a package around a robot's description.

    Args:
        folder: Where it is made.
        package: Its name, `my_rover_description`.
        template: Of the robot.
        text: Of the robot, in place of a template's.

    Raises:
        NotMadeError: The name is none for a package, or something bears it there.
    """
    if fault := name_fault(package):
        raise NotMadeError(package, fault)
    robot = text or template_text(template, robot_of(package))
    files = {name: data.decode() for name, data in description_files(package, robot).items()}
    return _edit(folder, package, files, next(one for one in files if one.startswith("urdf/")))


def _edit(folder: Path, name: str, files: dict[str, str], opened: str) -> PackageEdit:
    target = free_folder(folder, name)
    new = tuple(NewFile(str(target / one), text) for one, text in files.items())
    return PackageEdit(f"New package {name}", str(target / opened), new)
