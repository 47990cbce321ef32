"""Stand-ins for names that the studio does not know: they take anything and start nothing."""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

from studio.launch.vocabulary.actions import Action
from studio.launch.vocabulary.context import current_host
from studio.launch.vocabulary.places import here
from studio.launch.vocabulary.texts import Substitution

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.launch.vocabulary.context import LaunchContext

HELPERS: Final = {
    "moveit_configs_utils": "MoveIt's helper, which reads a robot's MoveIt config package",
    "moveit_configs_utils.launches": "MoveIt's helper, which makes launch descriptions",
    "nav2_common": "Nav2's helper, which rewrites files of parameters",
    "controller_manager": "ros2_control's helper, which makes spawners",
    "launch_testing": "a helper for tests",
    "launch_pytest": "a helper for tests",
    "launch_param_builder": "a helper that reads files of parameters",
    "ros_gz_sim": "Gazebo's helper",
    "ros_gz_bridge": "Gazebo's helper",
    "webots_ros2_driver": "Webots's helper",
}
"""Modules of ROS that launch files import, and what they are."""


class Placeholder(Action, Substitution):
    """Stands for a thing of a name that is not known, and for all that is made of it."""

    is_placeholder = True

    def __init__(self, name: str) -> None:
        Action.__init__(self)
        self._name = name

    def __call__(self, *_: Any, **__: Any) -> Placeholder:
        return Placeholder(self._name)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name in ("entities", "shown_name"):
            raise AttributeError(name)
        return Placeholder(f"{self._name}.{name}" if self._name.count(".") < 8 else self._name)

    def __getitem__(self, _: Any) -> Placeholder:
        return Placeholder(self._name)

    def __iter__(self) -> Iterator[Any]:
        return iter(())

    def __len__(self) -> int:
        return 0

    def __bool__(self) -> bool:
        return True

    def __or__(self, other: Any) -> Any:
        return other

    __ror__ = __or__

    def __add__(self, other: Any) -> Any:
        return f"{self}{other}" if isinstance(other, str) else other

    def __radd__(self, other: Any) -> Any:
        return f"{other}{self}" if isinstance(other, str) else other

    def __contains__(self, _: Any) -> bool:
        return False

    def __str__(self) -> str:
        return f"$(unsupported {self._name})"

    __repr__ = __fspath__ = __str__

    def keys(self) -> list[str]:
        """Be a dict without anything in it, for `**`."""
        return []

    def perform(self, context: LaunchContext) -> str:
        return str(self)

    def describe(self) -> str:
        return str(self)

    def execute(self, context: LaunchContext) -> None:
        context.host.unsupported(self._name, f"not supported: {self._name} is left out", self.where)


class PlaceholderModule(ModuleType):
    """A module whose names are all stand-ins; each is noted where it is imported."""

    def __init__(self, name: str, why: str) -> None:
        super().__init__(name)
        self.__path__ = []
        self._why = why

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        whole = f"{self.__name__}.{name}"
        current_host().unsupported(whole, f"not supported: {whole} ({self._why})", here())
        return placeholder_class(whole)


def placeholder_class(name: str) -> Any:
    """Return a class that a launch file may call, or derive a class of its own from."""

    def __init__(self: Any, *_: Any, **__: Any) -> None:  # noqa: N807
        Placeholder.__init__(self, name)

    made = _Meta(name.rpartition(".")[2], (Placeholder,), {"__init__": __init__})
    made.__module__ = name.rpartition(".")[0]
    return made


class _Meta(type):
    """Lets names of the class itself be stand-ins, such as those of an enumeration."""

    def __getattr__(cls, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return Placeholder(f"{cls.__name__}.{name}")


def note_missing_name(module: str, name: str) -> Any:
    """Note a name that a known module of ROS has not here, and return a stand-in."""
    whole = f"{module}.{name}"
    sentence = f"not supported: the studio knows no {name} in {module}, and leaves it out"
    current_host().unsupported(whole, sentence, here())
    return placeholder_class(whole)
