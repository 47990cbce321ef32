"""LaunchDescription, and the actions of launch that start nothing by themselves."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, cast

from studio.errors import LaunchError, SubstitutionFailure
from studio.launch.vocabulary.places import here
from studio.launch.vocabulary.requests import Later
from studio.launch.vocabulary.texts import (
    SomeText,
    as_float,
    described,
    is_unknown,
    perform,
    to_texts,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.launch.vocabulary.conditions import Condition
    from studio.launch.vocabulary.context import LaunchContext

MAX_ROUNDS = 10_000
"""Of one ForLoop."""


class LaunchDescriptionEntity:
    """What a launch description may hold."""

    def visit(self, context: LaunchContext) -> Iterable[Any] | None:
        """Do it; gives what is to be visited next."""
        raise NotImplementedError(f"visit of {type(self).__name__}, given {context}")

    def describe(self) -> str:
        """Return what it is, in a few words."""
        return type(self).__name__


class LaunchDescription(LaunchDescriptionEntity):
    """A list of what is to be done."""

    def __init__(
        self,
        initial_entities: Iterable[Any] | None = None,
        *,
        deprecated_reason: str | None = None,
    ) -> None:
        self.where = here()
        self.entities: list[Any] = list(initial_entities) if initial_entities is not None else []
        self.deprecated_reason = deprecated_reason

    def visit(self, context: LaunchContext) -> Iterable[Any] | None:
        if self.deprecated_reason is not None:
            context.host.log(
                "warn", f"this launch file is deprecated: {self.deprecated_reason}", self.where
            )
        return self.entities

    describe_sub_entities = property(lambda self: self.entities)

    @property
    def deprecated(self) -> bool:
        return self.deprecated_reason is not None

    def add_entity(self, entity: Any) -> None:
        self.entities.append(entity)

    def add_action(self, action: Any) -> None:
        self.entities.append(action)

    def get_launch_arguments(self, conditional_inclusion: bool = False) -> list[Any]:
        return [one for one in self.entities if isinstance(one, DeclareLaunchArgument)]


class Action(LaunchDescriptionEntity):
    """What is done where its condition holds."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self.where = here()
        self.condition = condition

    def visit(self, context: LaunchContext) -> Iterable[Any] | None:
        if self.condition is None or self.condition.evaluate(context):
            return self.execute(context)
        return None

    def execute(self, context: LaunchContext) -> Iterable[Any] | None:
        """Do it; gives what is to be visited next."""
        raise NotImplementedError(f"execute of {type(self).__name__}, given {context}")


class DeclareLaunchArgument(Action):
    """An argument of the launch file."""

    def __init__(
        self,
        name: str,
        *,
        default_value: SomeText | None = None,
        description: str | None = None,
        choices: Iterable[str] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.name = name
        self.default_value = None if default_value is None else to_texts(default_value)
        self.choices = None if choices is None else [str(one) for one in choices]
        self.description = description or ""
        if choices is not None and not self.choices:
            raise ValueError("provided choices argument is empty: give one, or leave it out")

    def execute(self, context: LaunchContext) -> None:
        context.host.declare(self, context)


class SetLaunchConfiguration(Action):
    """Sets what LaunchConfiguration reads."""

    def __init__(self, name: SomeText, value: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = to_texts(name), to_texts(value)

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations[perform(context, self.name)] = perform(context, self.value)

    def describe(self) -> str:
        return f"set {described(self.name)} to {described(self.value)}"


class UnsetLaunchConfiguration(Action):
    """Forgets a value."""

    def __init__(self, name: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = to_texts(name)

    def execute(self, context: LaunchContext) -> None:
        context.launch_configurations.pop(perform(context, self.name), None)


class ResetLaunchConfigurations(Action):
    """Forgets all values but those given."""

    def __init__(
        self, launch_configurations: Mapping[Any, Any] | None = None, **kwargs: Any
    ) -> None:
        super().__init__(**kwargs)
        self.kept = dict(launch_configurations or {})

    def execute(self, context: LaunchContext) -> None:
        kept = {perform(context, k): perform(context, v) for k, v in self.kept.items()}
        context.launch_configurations.clear()
        context.launch_configurations.update(kept)


class PushLaunchConfigurations(Action):
    """Keeps all values, for PopLaunchConfigurations."""

    def execute(self, context: LaunchContext) -> None:
        context.push()


class PopLaunchConfigurations(Action):
    """Comes back to the values that were kept."""

    def execute(self, context: LaunchContext) -> None:
        context.pop()


class PushEnvironment(PushLaunchConfigurations):
    """Keeps the environment."""


class PopEnvironment(PopLaunchConfigurations):
    """Comes back to the environment that was kept."""


class ResetEnvironment(Action):
    """Comes back to the environment that the launch began with."""

    def execute(self, context: LaunchContext) -> None:
        context.host.unsupported(
            "ResetEnvironment", "not supported: ResetEnvironment is left out", self.where
        )


class SetEnvironmentVariable(Action):
    """Sets a variable of the environment."""

    def __init__(self, name: SomeText, value: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name, self.value = to_texts(name), to_texts(value)

    def execute(self, context: LaunchContext) -> None:
        name, value = perform(context, self.name), perform(context, self.value)
        context.host.set_environment(
            name, self.changed(context.environment.get(name), value), self.where
        )

    def changed(self, before: str | None, value: str) -> str:
        """Return what the variable becomes."""
        return value


class AppendEnvironmentVariable(SetEnvironmentVariable):
    """Adds to a variable of the environment, which holds a list."""

    def __init__(
        self,
        name: SomeText,
        value: SomeText,
        prepend: Any = False,
        separator: SomeText = os.pathsep,
        **kwargs: Any,
    ) -> None:
        super().__init__(name, value, **kwargs)
        self.prepend, self.separator = prepend, separator

    def changed(self, before: str | None, value: str) -> str:
        if not before:
            return value
        separator = self.separator if isinstance(self.separator, str) else os.pathsep
        parts = [value, before] if self.prepend is True else [before, value]
        return separator.join(parts)


class UnsetEnvironmentVariable(Action):
    """Removes a variable of the environment."""

    def __init__(self, name: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = to_texts(name)

    def execute(self, context: LaunchContext) -> None:
        context.host.set_environment(perform(context, self.name), None, self.where)


class LogInfo(Action):
    """Logs a line."""

    level = "info"

    def __init__(self, *, msg: SomeText, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.msg = to_texts(msg)

    def execute(self, context: LaunchContext) -> None:
        context.host.log(self.level, perform(context, self.msg), self.where)

    def describe(self) -> str:
        return f"log: {described(self.msg)}"


class LogWarning(LogInfo):
    """Logs a warning."""

    level = "warn"


class LogError(LogInfo):
    """Logs an error."""

    level = "error"


class LogDebug(LogInfo):
    """Logs a line for debugging."""

    level = "debug"


class Log(LogInfo):
    """Logs a line at a level."""

    def __init__(self, *, msg: SomeText, level: SomeText, **kwargs: Any) -> None:
        super().__init__(msg=msg, **kwargs)
        self.level = described(level).lower()


class OpaqueFunction(Action):
    """A Python function of the launch file."""

    def __init__(
        self,
        *,
        function: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        **left: Any,
    ) -> None:
        super().__init__(**left)
        self.function, self.args, self.kwargs = function, list(args or ()), dict(kwargs or {})

    def execute(self, context: LaunchContext) -> Iterable[Any] | None:
        return self.function(context, *self.args, **self.kwargs)

    def describe(self) -> str:
        return f"the function {getattr(self.function, '__name__', '')}"


class OpaqueCoroutine(Action):
    """A coroutine of the launch file, which runs beside it."""

    def __init__(
        self,
        *,
        coroutine: Callable[..., Any],
        args: Iterable[Any] | None = None,
        kwargs: Mapping[str, Any] | None = None,
        ignore_context: bool = False,
        **left: Any,
    ) -> None:
        super().__init__(**left)
        self.coroutine, self.args, self.kwargs = coroutine, list(args or ()), dict(kwargs or {})
        self.ignore_context = ignore_context

    def execute(self, context: LaunchContext) -> None:
        if context.host.plans or context.asyncio_loop is None:
            context.host.unsupported(
                "OpaqueCoroutine", "what a coroutine does is known only when it runs", self.where
            )
            return
        first = [] if self.ignore_context else [context]
        task = context.asyncio_loop.create_task(self.coroutine(*first, *self.args, **self.kwargs))
        context.locals.tasks = [*getattr(context.locals, "tasks", []), task]


class GroupAction(Action):
    """Actions that share a condition, and settings that end with them."""

    def __init__(
        self,
        actions: Iterable[Any],
        *,
        scoped: bool = True,
        forwarding: bool = True,
        launch_configurations: Mapping[Any, Any] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.actions = list(actions)
        self.scoped, self.forwarding = scoped, forwarding
        self.launch_configurations = dict(launch_configurations or {})

    def get_sub_entities(self) -> list[Any]:
        return self.actions

    def execute(self, context: LaunchContext) -> None:
        given = {
            perform(context, k): perform(context, v) for k, v in self.launch_configurations.items()
        }
        if not self.scoped:
            context.launch_configurations.update(given)
            context.host.walk(self.actions, context)
            return
        context.push()
        try:
            if not self.forwarding:
                context.launch_configurations.clear()
            context.launch_configurations.update(given)
            context.host.walk(self.actions, context)
        finally:
            context.pop()


class IncludeLaunchDescription(Action):
    """Another launch file, with arguments for it."""

    def __init__(
        self,
        launch_description_source: Any,
        *,
        launch_arguments: Iterable[tuple[SomeText, SomeText]] | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        from studio.launch.vocabulary.sources import as_source  # noqa: PLC0415

        self.launch_description_source = as_source(launch_description_source)
        self.launch_arguments = [(to_texts(k), to_texts(v)) for k, v in _pairs(launch_arguments)]

    def execute(self, context: LaunchContext) -> None:
        given = {perform(context, k): perform(context, v) for k, v in self.launch_arguments}
        context.host.include(self, given, context)

    def describe(self) -> str:
        return f"include {described(self.launch_description_source.location)}"


def _pairs(launch_arguments: Any) -> Iterable[tuple[Any, Any]]:
    if isinstance(launch_arguments, dict):
        return cast("dict[Any, Any]", launch_arguments).items()
    return launch_arguments or ()


class ForLoop(Action):
    """Actions once for each set of values, written `name: a, other: b; name: c`."""

    def __init__(
        self,
        data_or_name: str = "",
        *,
        function: Callable[..., Any] | None = None,
        input_arg_name: str = "",
        name: str | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.input_arg_name = input_arg_name or data_or_name
        self.function, self.name = function, name

    def execute(self, context: LaunchContext) -> list[Any]:
        text = str(context.launch_configurations.get(self.input_arg_name, ""))
        rounds: list[Any] = []
        if self.function is None or is_unknown(text):
            return rounds
        for index, part in enumerate(text.split(";")):
            if index >= MAX_ROUNDS:
                raise LaunchError(f"a ForLoop has more than {MAX_ROUNDS} rounds: make fewer")
            values = dict(_named(one) for one in part.split(",") if ":" in one)
            if values:
                rounds += self.function(**values) or []
        return rounds


class ForEach(ForLoop):
    """As ForLoop, under its newer name."""


def _named(text: str) -> tuple[str, str]:
    name, _, value = text.partition(":")
    return name.strip(), value.strip()


class TimerAction(Action):
    """Actions after some seconds."""

    def __init__(
        self,
        *,
        period: Any,
        actions: Iterable[Any],
        cancel_on_shutdown: Any = True,
        **kwargs: Any,
    ) -> None:
        super().__init__(**kwargs)
        self.period, self.actions = period, list(actions)
        self._handle: Any = None

    def execute(self, context: LaunchContext) -> None:
        seconds = as_float(context, self.period)
        later = Later("timer", f"after {seconds:g} s", self.actions, None, seconds, self.where)
        self._handle = context.host.later(later, context)

    def cancel(self) -> None:
        """Do it no more."""
        from studio.launch.vocabulary.context import current_host  # noqa: PLC0415

        if self._handle is not None:
            current_host().forget(self._handle)

    def describe(self) -> str:
        return f"wait {self.period} s"


class Timer(TimerAction):
    """As TimerAction, under its older name."""


class EmitEvent(Action):
    """Has an event happen."""

    def __init__(self, *, event: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event = event

    def execute(self, context: LaunchContext) -> None:
        context.host.emit(self.event, context)

    def describe(self) -> str:
        return f"emit {type(self.event).__name__}"


class Shutdown(Action):
    """Ends the launch."""

    def __init__(self, *, reason: SomeText = "reason not given", **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.reason = reason

    def execute(self, context: LaunchContext) -> None:
        from studio.launch.vocabulary.events import Shutdown as ShutdownEvent  # noqa: PLC0415

        context.host.emit(ShutdownEvent(reason=perform(context, self.reason)), context)

    def __call__(self, event: Any, context: LaunchContext) -> None:
        """Be taken as a function, as `on_exit=Shutdown()` is."""
        self.visit(context)

    def describe(self) -> str:
        return f"end the launch ({described(self.reason)})"


class ShutdownAction(Shutdown):
    """As Shutdown."""


class RegisterEventHandler(Action):
    """Has something be done when an event happens."""

    def __init__(self, event_handler: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        self.event_handler.register(context)


class UnregisterEventHandler(Action):
    """Has it be done no more."""

    def __init__(self, event_handler: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        self.event_handler.unregister(context)


class ReadyToTest(Action):
    """Where a test begins: nothing is done here."""

    def execute(self, context: LaunchContext) -> None:
        pass


__all__ = ["SubstitutionFailure"]
