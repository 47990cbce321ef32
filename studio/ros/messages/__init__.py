"""Message classes by import: `from studio.ros.messages.std_msgs.msg import String`.

The modules below this one are made by an import hook when they are asked for, from the types of
the shared library. The hook answers only for names below this package.
"""

from __future__ import annotations

import os
import sys
from functools import cache
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from studio.errors import RosNameError, StudioError, UnknownTypeError, WireSettingsError
from studio.ros.duration import make_messages_by
from studio.ros.names import INTERFACES_VARIABLE, KINDS, full_type_name
from studio.ros.profiles import JAZZY, PROFILES
from studio.ros.types.files import texts_at
from studio.ros.types.library import ActionType, ServiceType, TypeLibrary

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from types import ModuleType

    from studio.ros.types.classes import MessageValue

__all__ = [
    "INTERFACES_VARIABLE",
    "action",
    "add_own_types",
    "message",
    "service",
    "shared_types",
    "spec_of_types",
    "types_of",
]


@cache
def types_of(distro: str) -> TypeLibrary:
    """Return the library of a distribution, one for the whole process, with the user's own types.

    Raises:
        WireSettingsError: The environment names types that are missing or not valid.
    """
    library = TypeLibrary(distro)
    add_own_types(library)
    return library


def add_own_types(library: TypeLibrary, environment: Mapping[str, str] = os.environ) -> None:
    """Add the types that the environment names; the library reports texts that are not valid.

    Raises:
        WireSettingsError: One of the paths does not exist, or has no types.
    """
    for path in filter(None, environment.get(INTERFACES_VARIABLE, "").split(os.pathsep)):
        try:
            library.add_sound_texts(texts_at(Path(path).expanduser().absolute()))
        except StudioError as error:
            raise WireSettingsError(f"{INTERFACES_VARIABLE}: {error}") from None


def shared_types() -> TypeLibrary:
    """Return the library of the distribution that ROS_DISTRO names, else of Jazzy."""
    named = os.environ.get("ROS_DISTRO", "").lower()
    return types_of(named if named in PROFILES else JAZZY.distro)


def message(name: str) -> type[MessageValue]:
    """Return the class of a message by its name, `std_msgs/msg/String` or `std_msgs/String`.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return shared_types().message(full_type_name(name, "msg"))


def service(name: str) -> ServiceType:
    """Return a service by its name, `std_srvs/srv/Trigger`.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return shared_types().service(full_type_name(name, "srv"))


def action(name: str) -> ActionType:
    """Return an action by its name, `turtlesim/action/RotateAbsolute`.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return shared_types().action(full_type_name(name, "action"))


_TYPE_GETTERS: dict[str, Callable[[str], object]] = {
    "msg": message,
    "srv": service,
    "action": action,
}


def install(package: str) -> None:
    """Install the hook for imports below `package`; again is harmless."""
    if not any(isinstance(finder, MessageFinder) for finder in sys.meta_path):
        sys.meta_path.append(MessageFinder(package))


class MessageFinder(MetaPathFinder):
    """Finds `<package>.std_msgs` and `<package>.std_msgs.msg`, and nothing outside of `package`."""

    def __init__(self, package: str) -> None:
        self._prefix = f"{package}."

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the module of a package that has types, or of one of its kinds."""
        del path, target
        if not fullname.startswith(self._prefix):
            return None
        package, _, kind = fullname.removeprefix(self._prefix).partition(".")
        return spec_of_types(fullname, package, kind)


def spec_of_types(fullname: str, package: str, kind: str) -> ModuleSpec | None:
    """Return the module of a package that has types (no kind), or of one of its kinds."""
    if kind not in {"", *KINDS} or not _names_in(package, kind):
        return None
    loader = _PackageLoader() if not kind else _KindLoader(package, kind)
    return ModuleSpec(fullname, loader, is_package=not kind)


class _PackageLoader(Loader):
    """Loads `std_msgs`, which is empty: its kinds are modules of their own."""

    def exec_module(self, module: ModuleType) -> None:
        module.__doc__ = f"The types of {module.__name__.rpartition('.')[2]}."


class _KindLoader(Loader):
    """Loads `std_msgs.msg`, which returns each type when it is asked for."""

    def __init__(self, package: str, kind: str) -> None:
        self._package, self._kind = package, kind

    def exec_module(self, module: ModuleType) -> None:
        package, kind = self._package, self._kind
        module.__doc__ = f"The types of {package}/{kind}."

        # Nothing is cached: when a user replaces a type, the next import must give the new one.
        def get_type(name: str) -> Any:  # noqa: ANN401
            try:
                return _TYPE_GETTERS[kind](f"{package}/{kind}/{name}")
            except (UnknownTypeError, RosNameError) as error:
                raise AttributeError(str(error)) from None

        def names() -> list[str]:
            return _names_in(package, kind)

        vars(module).update(__getattr__=get_type, __dir__=names)


def _names_in(package: str, kind: str) -> list[str]:
    start = f"{package}/{kind}/" if kind else f"{package}/"
    return [name.removeprefix(start) for name in shared_types().names() if name.startswith(start)]


install(__name__)
make_messages_by(message)
