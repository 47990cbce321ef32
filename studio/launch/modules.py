"""The modules that launch files import, for this process alone: a finder put first.

Nothing is installed under these names, and no ROS is used: a plan must not depend on the machine.
"""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.machinery
import inspect
import logging
import sys
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

from studio.files import is_file, is_folder
from studio.launch.vocabulary import (
    actions,
    conditions,
    context,
    events,
    handlers,
    nav2,
    parameters,
    processes,
    ros,
    sources,
    substitutions,
    texts,
    unknown,
)
from studio.packages.index import Rank

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from studio.packages.index import PackageIndex

_Names = dict[str, Any]


def _of(module: ModuleType, *names: str) -> _Names:
    return {name: getattr(module, name) for name in names}


_SUBSTITUTIONS: Final = _of(
    substitutions,
    "AllSubstitution", "AndSubstitution", "AnonName", "AnySubstitution", "BooleanSubstitution",
    "Command", "EnvironmentVariable", "EqualsSubstitution", "FileContent", "FindExecutable",
    "ForLoopIndex", "IfElseSubstitution", "LaunchConfiguration", "LocalSubstitution",
    "NotEqualsSubstitution", "NotSubstitution", "OrSubstitution", "PathJoinSubstitution",
    "PythonExpression", "StringJoinSubstitution", "TextSubstitution", "ThisLaunchFile",
    "ThisLaunchFileDir",
) | {"PathSubstitution": substitutions.PathJoinSubstitution,
     "SubstitutionFailure": substitutions.SubstitutionFailure}  # fmt: skip
_ACTIONS: Final = _of(
    actions,
    "AppendEnvironmentVariable", "DeclareLaunchArgument", "EmitEvent", "ForEach", "ForLoop",
    "GroupAction", "IncludeLaunchDescription", "Log", "LogDebug", "LogError", "LogInfo",
    "LogWarning", "OpaqueCoroutine", "OpaqueFunction", "PopEnvironment", "PopLaunchConfigurations",
    "PushEnvironment", "PushLaunchConfigurations", "RegisterEventHandler", "ResetEnvironment",
    "ResetLaunchConfigurations", "SetEnvironmentVariable", "SetLaunchConfiguration", "Shutdown",
    "ShutdownAction", "TimerAction", "UnregisterEventHandler", "UnsetEnvironmentVariable",
    "UnsetLaunchConfiguration",
) | _of(processes, "ExecuteLocal", "ExecuteProcess")  # fmt: skip
_HANDLERS: Final = _of(
    handlers,
    "OnExecutionComplete", "OnIncludeLaunchDescription", "OnProcessExit", "OnProcessIO",
    "OnProcessStart", "OnShutdown",
) | {"EventHandler": handlers.EventHandler}  # fmt: skip
_PROCESS_EVENTS: Final = _of(
    events,
    "ProcessExited", "ProcessIO", "ProcessStarted", "ProcessStderr", "ProcessStdin",
    "ProcessStdout", "ProcessTargetedEvent", "RunningProcessEvent", "ShutdownProcess",
    "SignalProcess",
)  # fmt: skip
_CONDITIONS: Final = _of(
    conditions,
    "IfCondition", "InvalidConditionExpressionError", "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals", "UnlessCondition", "evaluate_condition_expression",
)  # fmt: skip
_SOURCES: Final = _of(
    sources,
    "AnyLaunchDescriptionSource", "FrontendLaunchDescriptionSource",
    "PythonLaunchDescriptionSource",
) | {"LaunchDescriptionSource": sources.LaunchDescriptionSource}  # fmt: skip
_ROS_ACTIONS: Final = _of(
    ros,
    "ComposableNodeContainer", "LifecycleNode", "LifecycleTransition", "LoadComposableNodes",
    "Node", "PushRosNamespace", "RosTimer", "SetParameter", "SetParametersFromFile",
    "SetROSLogDir", "SetRemap", "SetUseSimTime",
) | {"PushROSNamespace": ros.PushRosNamespace, "ROSTimer": ros.RosTimer}  # fmt: skip
_ROS_SUBSTITUTIONS: Final = _of(
    substitutions, "ExecutableInPackage", "FindPackage", "FindPackagePrefix", "FindPackageShare"
) | {"FindPackage": substitutions.FindPackage, "Parameter": substitutions.ParameterSubstitution}
_DESCRIPTIONS: Final = _of(parameters, "Parameter", "ParameterFile", "ParameterValue") | {
    "ComposableNode": ros.ComposableNode
}


def _to_texts(value: object) -> list[Any]:
    return texts.to_texts(value)


def _perform_substitutions(launch_context: Any, subs: Any) -> str:
    return texts.perform(launch_context, subs)


def _type_utils() -> _Names:
    return {"perform_typed_substitution": lambda _context, value, _kind=None: value}


MODULES: Final[dict[str, _Names]] = {
    "launch": {
        "Action": actions.Action,
        "Condition": conditions.Condition,
        "Event": events.Event,
        "EventHandler": handlers.EventHandler,
        "BaseEventHandler": handlers.BaseEventHandler,
        "LaunchContext": context.LaunchContext,
        "LaunchDescription": actions.LaunchDescription,
        "LaunchDescriptionEntity": actions.LaunchDescriptionEntity,
        "LaunchDescriptionSource": sources.LaunchDescriptionSource,
        "SomeActionsType": object,
        "SomeEntitiesType": object,
        "SomeSubstitutionsType": object,
        "Substitution": texts.Substitution,
    },
    "launch.action": {"Action": actions.Action},
    "launch.actions": _ACTIONS,
    "launch.actions.opaque_function": _of(actions, "OpaqueFunction"),
    "launch.condition": {"Condition": conditions.Condition},
    "launch.conditions": _CONDITIONS,
    "launch.descriptions": {"Executable": processes.Executable},
    "launch.event": {"Event": events.Event},
    "launch.event_handler": {
        "EventHandler": handlers.EventHandler,
        "BaseEventHandler": handlers.BaseEventHandler,
    },
    "launch.event_handlers": _HANDLERS,
    "launch.event_handlers.on_process_exit": _of(handlers, "OnProcessExit"),
    "launch.event_handlers.on_process_start": _of(handlers, "OnProcessStart"),
    "launch.events": _of(
        events, "ExecutionComplete", "IncludeLaunchDescription", "Shutdown", "TimerEvent"
    )
    | _of(events, "matches_action", "matches_executable", "matches_name", "matches_pid"),
    "launch.events.matchers": _of(
        events, "matches_action", "matches_executable", "matches_name", "matches_pid"
    ),
    "launch.events.process": _PROCESS_EVENTS,
    "launch.launch_context": {"LaunchContext": context.LaunchContext},
    "launch.launch_description": {"LaunchDescription": actions.LaunchDescription},
    "launch.launch_description_entity": {
        "LaunchDescriptionEntity": actions.LaunchDescriptionEntity
    },
    "launch.launch_description_source": {
        "LaunchDescriptionSource": sources.LaunchDescriptionSource
    },
    "launch.launch_description_sources": _SOURCES,
    "launch.some_actions_type": {"SomeActionsType": object},
    "launch.some_entities_type": {"SomeEntitiesType": object},
    "launch.some_substitutions_type": {
        "SomeSubstitutionsType": object,
        "SomeSubstitutionsType_types_tuple": (str, texts.Substitution, list, tuple),
    },
    "launch.substitution": {"Substitution": texts.Substitution},
    "launch.substitutions": _SUBSTITUTIONS,
    "launch.substitutions.substitution_failure": {
        "SubstitutionFailure": substitutions.SubstitutionFailure
    },
    "launch.utilities": {
        "normalize_to_list_of_substitutions": _to_texts,
        "perform_substitutions": _perform_substitutions,
    },
    "launch.utilities.type_utils": _type_utils(),
    "launch.frontend": {},
    "launch.logging": {"get_logger": logging.getLogger},
    "launch_ros": {"default_context": None},
    "launch_ros.actions": _ROS_ACTIONS,
    "launch_ros.descriptions": _DESCRIPTIONS,
    "launch_ros.event_handlers": _of(handlers, "OnStateTransition"),
    "launch_ros.events": {"matches_node_name": events.matches_node_name},
    "launch_ros.events.lifecycle": _of(events, "ChangeState", "StateTransition"),
    "launch_ros.events.matchers": {"matches_node_name": events.matches_node_name},
    "launch_ros.parameter_descriptions": _of(
        parameters, "Parameter", "ParameterFile", "ParameterValue"
    ),
    "launch_ros.parameters_type": {"SomeParameters": object, "SomeParameterValue": object},
    "launch_ros.remap_rule_type": {"SomeRemapRules": object},
    "launch_ros.substitutions": _ROS_SUBSTITUTIONS,
    "launch_ros.utilities": {},
    "launch_xml": {},
    "launch_xml.launch_description_sources": _of(sources, "XMLLaunchDescriptionSource"),
    "launch_yaml": {},
    "launch_yaml.launch_description_sources": _of(sources, "YAMLLaunchDescriptionSource"),
    "nav2_common": {},
    "nav2_common.launch": _of(nav2, "ReplaceString", "RewrittenYaml"),
}
"""By module, the names that it has here."""


def module_of(name: str) -> str | None:
    """Return the module that a name is imported from in a launch file; None: of none here."""
    best = ("launch", "launch.actions", "launch.substitutions", "launch.conditions",
            "launch.event_handlers", "launch.launch_description_sources", "launch_ros.actions",
            "launch_ros.substitutions", "launch_ros.descriptions", "launch.events")  # fmt: skip
    if name == "get_package_share_directory":
        return "ament_index_python.packages"
    return next((one for one in best if name in MODULES[one]), None)


class LaunchModule(ModuleType):
    """A module of the vocabulary; a name that it has not becomes a stand-in, and a row."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        whole = f"{self.__name__}.{name}"
        if whole in MODULES:  # as in ROS, where `import launch` brings `launch.actions`
            return importlib.import_module(whole)
        return unknown.note_missing_name(self.__name__, name)


class Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds the vocabulary, what stands for ROS's helpers, and packages of the workspace."""

    def __init__(self, extra: dict[str, _Names], folder_of: Callable[[str], str | None]) -> None:
        self._modules = MODULES | extra
        self._folder_of = folder_of

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Find a module of ours; a workspace's package by the folder that it lies in."""
        del target
        top = fullname.partition(".")[0]
        if fullname in self._modules or top in _OURS or top in unknown.HELPERS:
            return importlib.machinery.ModuleSpec(fullname, self, is_package=True)
        if path is None and (folder := self._folder_of(fullname)) is not None:
            return importlib.machinery.PathFinder.find_spec(fullname, [folder])
        return None

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        """Make it."""
        name = spec.name
        if name in self._modules:
            made = LaunchModule(name)
            made.__dict__.update(self._modules[name])
            return made
        if name.partition(".")[0] in unknown.HELPERS:
            why = unknown.HELPERS.get(name) or unknown.HELPERS[name.partition(".")[0]]
            return unknown.PlaceholderModule(name, why)
        return unknown.PlaceholderModule(name, "a module of launch that the studio does not know")

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing more: its names are there."""


class ProgramFinder(importlib.abc.MetaPathFinder):
    """Finds what a node may import, message packages for example; made at the first need."""

    def __init__(self) -> None:
        self._finder: importlib.abc.MetaPathFinder | None = None
        self._is_making = False

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Find a module as `studio run` does."""
        if self._is_making or _importer().startswith(_LIBRARIES):
            return None
        if self._finder is None:
            self._is_making = True
            try:
                from studio.importable.finder import RosFinder  # noqa: PLC0415 - takes long
                from studio.importable.workspace import Workspace  # noqa: PLC0415

                self._finder = RosFinder(Workspace())
            finally:
                self._is_making = False
        try:
            return self._finder.find_spec(fullname, path, target)
        except ModuleNotFoundError:
            return None


class LastFinder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Makes stand-ins of modules that nobody has, while planning."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        """Stand in for what a launch file imports, not for what a library looks for."""
        del path, target
        top = fullname.partition(".")[0]
        if top in sys.stdlib_module_names or _importer().startswith(_LIBRARIES):
            return None
        return importlib.machinery.ModuleSpec(fullname, self, is_package=True)

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        """Make it."""
        why = f"the module {spec.name} is not on this machine, what it computes is not known"
        return unknown.PlaceholderModule(spec.name, why)

    def exec_module(self, module: ModuleType) -> None:
        """Do nothing more."""


_LIBRARIES: Final = ("studio.", "yaml", "numpy", "xml", "json", "msgspec", "xacro")
_OURS: Final = frozenset({"launch", "launch_ros", "launch_xml", "launch_yaml"})


def _importer() -> str:
    """Return the name of the module that imports right now."""
    frame = inspect.currentframe()
    while frame is not None:
        name = str(frame.f_globals.get("__name__", ""))
        if not name.startswith(("importlib", "studio.launch.modules", "_frozen_importlib")):
            return name
        frame = frame.f_back
    return ""


def install(index: PackageIndex, asking: Path, *, stand_in: bool) -> None:
    """Have this process import the vocabulary, and the packages of an index as a file sees them.

    Args:
        index: The packages: ament_index_python finds them, and their Python can be imported.
        asking: The launch file.
        stand_in: Makes one of what is missing: for planning, which goes on without it.
    """
    sys.meta_path.insert(0, Finder(_ament_index(index, asking), _module_folders(index)))
    sys.meta_path.append(ProgramFinder())
    if stand_in:
        sys.meta_path.append(LastFinder())


def _ament_index(index: PackageIndex, asking: Path) -> dict[str, _Names]:
    """Return ament_index_python, by the packages of an index as a file sees them."""
    from studio.importable import ament_index as found  # noqa: PLC0415
    from studio.launch.shares import links_folder  # noqa: PLC0415

    installed = {one.folder for one in index.packages if one.rank is Rank.INSTALLED}

    def packages() -> dict[str, Path]:
        folders = {name: index.best(name, asking) for name in sorted(index.names)}
        return {name: folder for name, folder in folders.items() if folder not in installed}

    found.use_packages(packages, links_folder)
    names = _of(
        found,
        "InvalidResourceNameError", "InvalidResourceTypeNameError", "PackageNotFoundError",
        "get_package_prefix", "get_package_share_directory", "get_package_share_path",
        "get_packages_with_prefixes", "get_resource", "get_resource_types", "get_resources",
        "get_search_paths", "has_resource",
    )  # fmt: skip
    parts = ("", ".packages", ".resources", ".search_paths")
    return {f"ament_index_python{part}": names for part in parts}


def _module_folders(index: PackageIndex) -> Callable[[str], str | None]:
    """Return what gives the folder of a workspace's module, which launch files may import."""

    def folder_of(name: str) -> str | None:
        if name not in index:
            return None
        for one in index.packages:
            if one.name != name or one.folder.parent.name == "share":
                continue
            for root in (one.folder, one.folder / "src"):
                if is_folder(root / name) and is_file(root / name / "__init__.py"):
                    return str(root)
        return None

    return folder_of
