"""What a person wants of a new package, in the words of `ros2 pkg create`, and what forbids it."""

from __future__ import annotations

import keyword
import re
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.packages.skeleton import name_fault

if TYPE_CHECKING:
    from collections.abc import Iterator

BuildType: TypeAlias = Literal["ament_cmake", "ament_python", "cmake"]
BUILD_TYPES: Final[tuple[BuildType, ...]] = ("cmake", "ament_cmake", "ament_python")
NO_DESCRIPTION: Final = "TODO: Package description"
NO_LICENSE: Final = "TODO: License declaration"
TEXT_LIMIT: Final = 2_000
DEPENDENCIES_MAX: Final = 200
_DEPENDENCY: Final = re.compile(r"[a-zA-Z][a-zA-Z0-9_.+-]{0,199}")
_EXECUTABLE: Final = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,99}")
_EMAIL: Final = re.compile(r"[^\s@<>\"']+@[^\s@<>\"']+")


@dataclass(frozen=True, slots=True)
class NewPackage:
    """A package that is to be made; the defaults are those of `ros2 pkg create`."""

    name: str
    build_type: BuildType = "ament_cmake"
    dependencies: tuple[str, ...] = ()
    node_name: str = ""
    library_name: str = ""
    license: str = NO_LICENSE
    description: str = NO_DESCRIPTION
    maintainer_name: str = "user"
    maintainer_email: str = "user@todo.todo"
    package_format: int = 3
    version: str = "0.0.0"
    has_interfaces: bool = False
    """Whether code is to be made of messages, services and actions, of which it has none yet."""

    @property
    def is_python(self) -> bool:
        """Whether setuptools builds it."""
        return self.build_type == "ament_python"


def faults(new: NewPackage) -> Iterator[str]:
    """Yield why this package cannot be made, a sentence each."""
    if fault := name_fault(new.name) or (module_fault(new.name) if new.is_python else ""):
        yield fault
    if new.build_type not in BUILD_TYPES:
        yield f'"{new.build_type}" is no build type: choose one of {", ".join(BUILD_TYPES)}.'
    if new.package_format not in (2, 3):
        yield f"package.xml has the formats 2 and 3, not {new.package_format}."
    if new.has_interfaces and new.build_type != "ament_cmake":
        yield f"Of interfaces code is made in a package of ament_cmake, not of {new.build_type}."
    yield from _dependency_faults(new)
    yield from _program_faults(new)
    yield from _text_faults(new)


def module_fault(name: str) -> str:
    """Return why a Python module must not be called so, a sentence; empty if it may."""
    if keyword.iskeyword(name) or keyword.issoftkeyword(name):
        return f'"{name}" is a word of Python\'s own: no module can be imported by it.'
    if name == "test":
        return 'A Python package named "test" would be taken for Python\'s own tests.'
    if name in sys.stdlib_module_names:
        return f'Python has a module "{name}" of its own, which this one would hide.'
    if name in {"rclpy", "launch", "launch_ros", "ament_index_python", "setuptools"}:
        return f'"{name}" is a package of ROS or Python that every node needs.'
    return ""


def _dependency_faults(new: NewPackage) -> Iterator[str]:
    if len(new.dependencies) > DEPENDENCIES_MAX:
        yield f"{len(new.dependencies)} dependencies are more than any package has."
    for one in new.dependencies:
        if not _DEPENDENCY.fullmatch(one):
            yield f'"{one[:80]}" is no name of a package to depend on.'
        elif one == new.name:
            yield f"{one} cannot depend on itself."


def _program_faults(new: NewPackage) -> Iterator[str]:
    for what, name in (("node", new.node_name), ("library", new.library_name)):
        if name and not _EXECUTABLE.fullmatch(name):
            yield f'"{name[:80]}" is no name for a {what}: use letters, digits and "_".'
        elif name and new.is_python and keyword.iskeyword(name):
            yield f'"{name}" is a word of Python\'s own and cannot name a module.'
    if new.node_name and new.node_name == new.library_name:
        yield f'The node and the library cannot both be called "{new.node_name}".'
    if new.library_name and new.library_name == new.name and not new.is_python:
        yield (
            f'The library cannot be called "{new.name}" like the package: CMake has that target '
            "for the project itself."
        )


def _text_faults(new: NewPackage) -> Iterator[str]:
    fields = {
        "description": new.description,
        "license": new.license,
        "maintainer's name": new.maintainer_name,
    }
    for what, text in fields.items():
        if not text.strip():
            yield f"The {what} is empty."
        elif len(text) > TEXT_LIMIT:
            yield f"The {what} has more than {TEXT_LIMIT} characters."
        elif any(not one.isprintable() and one not in "\n\t" for one in text):
            yield f"The {what} holds characters that cannot be written into package.xml."
    if not _EMAIL.fullmatch(new.maintainer_email):
        yield f'"{new.maintainer_email[:80]}" is no e-mail address: give --maintainer-email.'
    if not re.fullmatch(r"\d+\.\d+\.\d+", new.version):
        yield f'"{new.version}" is no version: package.xml wants three numbers, 0.1.0.'
