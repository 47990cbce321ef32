"""New packages beside others, as edits: for interfaces, for a robot's description, or any other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import NotMadeError
from studio.files import is_there
from studio.packages.creation.new_package import NewPackage, faults
from studio.packages.creation.package_texts import package_files
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.skeleton import description_files, name_fault, robot_of, template_text
from studio.problems import NewFile

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.skeleton import Template


def new_package(folder: Path, new: NewPackage) -> PackageEdit:
    """Return the edit that makes a package in a folder.

    Raises:
        NotMadeError: Something forbids it, or bears its name there.
    """
    if reasons := tuple(faults(new)):
        raise NotMadeError(new.name, " ".join(reasons))
    return _edit(folder, new.name, package_files(new), "package.xml")


def new_interface_package(folder: Path, new: NewPackage) -> PackageEdit:
    """Return the edit that makes a package of interfaces, none of which is in it yet.

    Raises:
        NotMadeError: Something forbids it, or bears its name there.
    """
    if reasons := tuple(faults(new)):
        raise NotMadeError(new.name, " ".join(reasons))
    files = package_files(new)
    files["package.xml"] = files["package.xml"].replace(
        "  <buildtool_depend>ament_cmake</buildtool_depend>\n",
        "  <buildtool_depend>ament_cmake</buildtool_depend>\n"
        "  <buildtool_depend>rosidl_default_generators</buildtool_depend>\n\n"
        "  <exec_depend>rosidl_default_runtime</exec_depend>\n",
    )
    files["package.xml"] = files["package.xml"].replace(
        "\n  <export>\n",
        "\n  <member_of_group>rosidl_interface_packages</member_of_group>\n\n  <export>\n",
    )
    files["CMakeLists.txt"] = files["CMakeLists.txt"].replace(
        "find_package(ament_cmake REQUIRED)\n",
        "find_package(ament_cmake REQUIRED)\nfind_package(rosidl_default_generators REQUIRED)\n",
    )
    return _edit(folder, new.name, files, "package.xml")


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
    target = folder / name
    if is_there(target):
        raise NotMadeError(
            str(target), "there is something of that name: choose another name or folder."
        )
    new = tuple(NewFile(str(target / one), text) for one, text in files.items())
    return PackageEdit(f"New package {name}", str(target / opened), new)
