"""The actions of launch_ros: nodes, and what they share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.launch.vocabulary.actions import Action, TimerAction
from studio.launch.vocabulary.context import current_host
from studio.launch.vocabulary.parameters import parameter_sets, value_of
from studio.launch.vocabulary.places import here
from studio.launch.vocabulary.processes import Executable, ExecuteLocal
from studio.launch.vocabulary.requests import Request
from studio.launch.vocabulary.texts import SomeText, described, is_unknown, perform, to_texts

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.launch.vocabulary.context import LaunchContext

_NAMESPACE = "ros_namespace"
_REMAPS = "ros_remaps"
_GLOBAL = "global_params"
_OLD = {"node_executable": "executable", "node_name": "name", "node_namespace": "namespace"}


def joined_namespace(base: str, own: str) -> str:
    """Return an absolute namespace: `own` within `base`, unless it is absolute itself."""
    whole = own if own.startswith("/") else f"{base.rstrip('/')}/{own}"
    return "/" + "/".join(part for part in whole.split("/") if part)


class Node(ExecuteLocal):
    """A node: an executable of a package."""

    kind = "node"

    def __init__(
        self,
        *,
        executable: SomeText | None = None,
        package: SomeText | None = None,
        name: SomeText | None = None,
        namespace: SomeText | None = None,
        exec_name: SomeText | None = None,
        parameters: Any = None,
        remappings: Iterable[tuple[SomeText, SomeText]] | None = None,
        ros_arguments: Iterable[SomeText] | None = None,
        arguments: Iterable[SomeText] | None = None,
        **kwargs: Any,
    ) -> None:
        old = {new: kwargs.pop(word) for word, new in _OLD.items() if word in kwargs}
        if old:
            _refuse_old(old)
        executable = old.get("executable", executable)
        if executable is None:
            raise TypeError(
                "Node.__init__() missing 1 required keyword-only argument: 'executable'"
            )
        if isinstance(arguments, str):
            raise TypeError("arguments is a text: it must be a list, write arguments=[...]")
        own = {
            key: kwargs.pop(key)
            for key in ("prefix", "cwd", "env", "additional_env")
            if key in kwargs
        }
        description = Executable(cmd=[executable], name=exec_name, **own)
        super().__init__(process_description=description, **kwargs)
        self.executable = to_texts(executable)
        self.package = None if package is None else to_texts(package)
        given_name = old.get("name", name)
        self.given_name = None if given_name is None else to_texts(given_name)
        given_namespace = old.get("namespace", namespace)
        self.given_namespace = None if given_namespace is None else to_texts(given_namespace)
        self.parameters, self.remappings = parameters, list(remappings or ())
        self.arguments = list(arguments or ())
        self.ros_arguments = list(ros_arguments or ())
        self._full_name = ""

    @property
    def node_name(self) -> str:
        return self._full_name or "<node_name_unspecified>"

    @property
    def node_package(self) -> Any:
        return self.package

    @property
    def node_executable(self) -> Any:
        return self.executable

    def is_node_name_fully_specified(self) -> bool:
        return self.given_name is not None

    def shown_name(self) -> str:
        parts = (self.given_name, self.executable)
        return next(described(one) for one in parts if one is not None)

    def describe(self) -> str:
        package = "" if self.package is None else f"{described(self.package)} "
        return f"start {package}{described(self.executable)}"

    def request(self, context: LaunchContext) -> Request:
        request = self.common(context, self.kind)
        request.package = "" if self.package is None else perform(context, self.package)
        request.executable = perform(context, self.executable)
        node_name = "" if self.given_name is None else perform(context, self.given_name)
        own = "" if self.given_namespace is None else perform(context, self.given_namespace)
        base = str(context.launch_configurations.get(_NAMESPACE, ""))
        request.namespace = joined_namespace(base, own)
        request.name = node_name
        request.full_name = f"{request.namespace.rstrip('/')}/{node_name}" if node_name else ""
        self._full_name = request.full_name
        request.parameters = parameter_sets(context, self.parameters)
        request.global_parameters = list(context.global_parameters)
        request.remaps = [
            *context.launch_configurations.get(_REMAPS, []),
            *((perform(context, a), perform(context, b)) for a, b in self.remappings),
        ]
        request.arguments = [perform(context, one) for one in self.arguments]
        request.ros_arguments = [perform(context, one) for one in self.ros_arguments]
        return request


def _refuse_old(words: Mapping[str, Any]) -> None:
    old = [word for word, new in _OLD.items() if new in words]
    sentence = (
        f"Node got {', '.join(old)}, which ROS 2 has not taken since Foxy: write "
        f"{', '.join(_OLD[word] for word in old)}"
    )
    host = current_host()
    if not host.plans:
        raise TypeError(sentence)
    host.failed(sentence, here())


class LifecycleNode(Node):
    """A node with a lifecycle."""

    kind = "lifecycle"

    def __init__(
        self, *, name: SomeText, namespace: SomeText, autostart: Any = False, **kwargs: Any
    ) -> None:
        super().__init__(name=name, namespace=namespace, **kwargs)
        self.autostart = autostart

    @property
    def is_lifecycle(self) -> bool:
        return True


class LifecycleTransition(Action):
    """Takes lifecycle nodes through transitions, given by their ids."""

    def __init__(
        self,
        *,
        lifecycle_node_names: Iterable[SomeText],
        transition_ids: Iterable[int],
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.names, self.ids = list(lifecycle_node_names), list(transition_ids)

    def execute(self, context: LaunchContext) -> None:
        from studio.launch.vocabulary.events import ChangeState, matches_node_name  # noqa: PLC0415

        for name in self.names:
            for number in self.ids:
                matcher = matches_node_name(perform(context, name))
                context.host.emit(
                    ChangeState(lifecycle_node_matcher=matcher, transition_id=number), context
                )


class ComposableNode:
    """A node that is loaded into a container."""

    def __init__(
        self,
        *,
        package: SomeText,
        plugin: SomeText,
        name: SomeText | None = None,
        namespace: SomeText | None = None,
        parameters: Any = None,
        remappings: Iterable[tuple[SomeText, SomeText]] | None = None,
        extra_arguments: Any = None,
        condition: Any = None,
        **_: Any,
    ) -> None:
        self.where = here()
        self.package, self.plugin = to_texts(package), to_texts(plugin)
        self.name, self.namespace, self.condition = name, namespace, condition
        self.parameters, self.remappings = parameters, list(remappings or ())
        self.extra_arguments = extra_arguments

    node_plugin = property(lambda self: self.plugin)

    def request(self, context: LaunchContext, container: str) -> Request:
        """Return what is to be loaded."""
        name = "" if self.name is None else perform(context, self.name)
        own = "" if self.namespace is None else perform(context, self.namespace)
        namespace = joined_namespace(str(context.launch_configurations.get(_NAMESPACE, "")), own)
        return Request(
            self,
            "composable",
            self.where,
            package=perform(context, self.package),
            executable=perform(context, self.plugin),
            name=name,
            namespace=namespace,
            full_name=f"{namespace.rstrip('/')}/{name}" if name else "",
            parameters=parameter_sets(context, self.parameters),
            global_parameters=list(context.global_parameters),
            remaps=[
                *context.launch_configurations.get(_REMAPS, []),
                *((perform(context, a), perform(context, b)) for a, b in self.remappings),
            ],
            container=container,
        )


class _Loaded(Action):
    """Stands for a composable node while it is visited, for its condition."""

    def __init__(self, one: ComposableNode, container: str) -> None:
        super().__init__(condition=one.condition)
        self.one, self.container, self.where = one, container, one.where

    def execute(self, context: LaunchContext) -> None:
        context.host.start(self.one.request(context, self.container), context)


class ComposableNodeContainer(Node):
    """A container, and the nodes that are loaded into it."""

    kind = "container"

    def __init__(
        self,
        *,
        name: SomeText,
        namespace: SomeText = "",
        composable_node_descriptions: Iterable[Any] | None = None,
        package: SomeText = "rclcpp_components",
        executable: SomeText = "component_container",
        **kwargs: Any,
    ) -> None:
        super().__init__(
            name=name, namespace=namespace, package=package, executable=executable, **kwargs
        )
        self.descriptions = list(composable_node_descriptions or ())

    def execute(self, context: LaunchContext) -> Any:
        super().execute(context)
        return [
            _Loaded(one, self.node_name)
            for one in self.descriptions
            if isinstance(one, ComposableNode)
        ]


class LoadComposableNodes(Action):
    """Loads nodes into a container that is there already."""

    def __init__(
        self,
        *,
        composable_node_descriptions: Iterable[Any],
        target_container: Any,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.descriptions, self.target_container = (
            list(composable_node_descriptions),
            target_container,
        )

    def execute(self, context: LaunchContext) -> list[Any]:
        if isinstance(self.target_container, Node):
            target = self.target_container.node_name
        else:
            target = perform(context, self.target_container)
            if not is_unknown(target):
                base = str(context.launch_configurations.get(_NAMESPACE, ""))
                target = joined_namespace(base, target)
        return [
            _Loaded(one, target) for one in self.descriptions if isinstance(one, ComposableNode)
        ]

    def describe(self) -> str:
        return f"load {len(self.descriptions)} nodes into a container"


class PushRosNamespace(Action):
    """Puts all nodes that follow into a namespace."""

    def __init__(self, namespace: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.namespace = to_texts(namespace)

    def execute(self, context: LaunchContext) -> None:
        base = str(context.launch_configurations.get(_NAMESPACE, ""))
        whole = joined_namespace(base, perform(context, self.namespace))
        context.launch_configurations[_NAMESPACE] = "" if whole == "/" else whole


class SetRemap(Action):
    """Renames a topic or service for all nodes that follow."""

    def __init__(self, src: SomeText, dst: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src, self.dst = to_texts(src), to_texts(dst)

    def execute(self, context: LaunchContext) -> None:
        pair = perform(context, self.src), perform(context, self.dst)
        context.launch_configurations.setdefault(_REMAPS, []).append(pair)


class SetParameter(Action):
    """Sets a parameter for all nodes that follow."""

    def __init__(self, name: SomeText, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = to_texts(name), value

    def execute(self, context: LaunchContext) -> None:
        name = perform(context, self.name)
        pair = name, value_of(context, self.value, name)
        context.launch_configurations.setdefault(_GLOBAL, []).append(pair)


class SetUseSimTime(SetParameter):
    """Sets use_sim_time for all nodes that follow."""

    def __init__(self, value: Any, **kwargs: Any) -> None:
        super().__init__("use_sim_time", value, **kwargs)


class SetParametersFromFile(Action):
    """Gives a file of parameters to all nodes that follow."""

    def __init__(self, filename: SomeText, *, node_name: Any = None, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.filename, self.node_name = to_texts(filename), node_name

    def execute(self, context: LaunchContext) -> None:
        pair = "", perform(context, self.filename)
        context.launch_configurations.setdefault(_GLOBAL, []).append(pair)


class RosTimer(TimerAction):
    """As TimerAction: by the clock of this machine."""


class SetROSLogDir(Action):
    """Names the folder of log files: the studio writes none."""

    def __init__(self, new_log_dir: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.new_log_dir = new_log_dir

    def execute(self, context: LaunchContext) -> None:
        context.host.set_environment("ROS_LOG_DIR", perform(context, self.new_log_dir), self.where)
