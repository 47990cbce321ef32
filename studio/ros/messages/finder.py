"""The hook behind imports of messages: packages and kinds become modules, types their names."""

from __future__ import annotations

import sys
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec
from typing import TYPE_CHECKING, Any

from studio.errors import RosNameError, UnknownTypeError
from studio.ros.messages.shared import action, message, service, shared_types
from studio.ros.names import KINDS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import ModuleType

_GIVEN_BY: dict[str, Callable[[str], object]] = {
    "msg": message,
    "srv": service,
    "action": action,
}


def install(package: str) -> None:
    """Answer imports below `package`; once is enough."""
    if not any(isinstance(finder, MessageFinder) for finder in sys.meta_path):
        sys.meta_path.append(MessageFinder(package))


class MessageFinder(MetaPathFinder):
    """Finds `<package>.std_msgs` and `<package>.std_msgs.msg`, and nothing outside of it."""

    def __init__(self, package: str) -> None:
        self._prefix = f"{package}."

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Give the module of a package that has types, or of one of its kinds."""
        del path, target
        if not fullname.startswith(self._prefix):
            return None
        package, _, kind = fullname.removeprefix(self._prefix).partition(".")
        if kind not in {"", *KINDS} or not _names_in(package, kind):
            return None
        loader = _PackageLoader() if not kind else _KindLoader(package, kind)
        return ModuleSpec(fullname, loader, is_package=not kind)


class _PackageLoader(Loader):
    """Fills `std_msgs` with nothing: its kinds are modules of their own."""

    def exec_module(self, module: ModuleType) -> None:
        module.__doc__ = f"The types of {module.__name__.rpartition('.')[2]}."


class _KindLoader(Loader):
    """Fills `std_msgs.msg`: each type is made when it is first asked for."""

    def __init__(self, package: str, kind: str) -> None:
        self._package, self._kind = package, kind

    def exec_module(self, module: ModuleType) -> None:
        package, kind = self._package, self._kind
        module.__doc__ = f"The types of {package}/{kind}."

        # Nothing is kept: a type that was given anew by a user is the new one.
        def give(name: str) -> Any:  # noqa: ANN401
            try:
                return _GIVEN_BY[kind](f"{package}/{kind}/{name}")
            except (UnknownTypeError, RosNameError) as error:
                raise AttributeError(str(error)) from None

        def names() -> list[str]:
            return _names_in(package, kind)

        vars(module).update(__getattr__=give, __dir__=names)


def _names_in(package: str, kind: str) -> list[str]:
    start = f"{package}/{kind}/" if kind else f"{package}/"
    return [name.removeprefix(start) for name in shared_types().names() if name.startswith(start)]
