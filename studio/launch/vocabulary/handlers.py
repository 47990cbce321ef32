"""Event handlers: what is done when something happens."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, cast

from studio.launch.vocabulary.events import (
    ExecutionComplete,
    ProcessExited,
    ProcessIO,
    ProcessStarted,
    Shutdown,
    StateTransition,
)
from studio.launch.vocabulary.places import here
from studio.launch.vocabulary.requests import Later

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.launch.vocabulary.context import LaunchContext


class BaseEventHandler:
    """Does something when an event is the one that it waits for."""

    kind = "other"

    def __init__(
        self, *, matcher: Callable[[Any], bool], handle_once: bool = False, **_: Any
    ) -> None:
        self.where = here()
        self.matcher, self.handle_once = matcher, handle_once
        self._handle: Any = None

    @property
    def when(self) -> str:
        """When that is, as half a sentence."""
        return "when an event comes that a function chooses"

    def matches(self, event: Any) -> bool:
        return bool(self.matcher(event))

    def entities_for(self) -> Any:
        """Return the actions, or the function that gives them."""
        return self.handle

    def handle(self, event: Any, context: LaunchContext) -> Any:
        """Do it; gives what is to be visited."""
        return None

    def register(self, context: LaunchContext) -> None:
        """Wait for the event from now on."""
        later = Later(
            self.kind,
            self.when,
            self.entities_for(),
            self.matches,
            None,
            self.where,
            self.handle_once,
        )
        self._handle = context.host.later(later, context)

    def unregister(self, context: LaunchContext) -> None:
        """Wait no more."""
        context.host.forget(self._handle)


class EventHandler(BaseEventHandler):
    """Visits actions when an event comes of which a function is true."""

    def __init__(
        self, *, matcher: Callable[[Any], bool], entities: Any = None, **kwargs: Any
    ) -> None:
        super().__init__(matcher=matcher, **kwargs)
        self.entities = entities

    def entities_for(self) -> Any:
        return self.entities if type(self).handle is EventHandler.handle else self.handle

    def handle(self, event: Any, context: LaunchContext) -> Any:
        return self.entities


def target_name(target: Any) -> str:
    """Name what a handler waits for, as a reader of the launch file would."""
    if target is None:
        return "any process"
    name = getattr(target, "shown_name", None)
    if name is not None:
        return str(name())
    if callable(target):
        return "a process that a function chooses"
    return type(target).__name__


class _OnAction(EventHandler):
    """Waits for an event of one action, or of any."""

    event: type[Any] = ProcessExited
    verb = "exits"

    def __init__(self, *, target_action: Any = None, entities: Any = None, **kwargs: Any) -> None:
        self.target = target_action
        super().__init__(matcher=self._is_it, entities=entities, **kwargs)

    def _is_it(self, event: Any) -> bool:
        if not isinstance(event, self.event):
            return False
        action = getattr(event, "action", None)
        if self.target is None or self.target is action:
            return True
        return callable(self.target) and bool(cast("Any", self.target)(action))

    @property
    def when(self) -> str:
        return f"when {target_name(self.target)} {self.verb}"


class OnProcessExit(_OnAction):
    """When a process has ended."""

    kind = "on_exit"

    def __init__(self, *, target_action: Any = None, on_exit: Any, **kwargs: Any) -> None:
        super().__init__(target_action=target_action, entities=on_exit, **kwargs)


class OnProcessStart(_OnAction):
    """When a process runs."""

    kind, event, verb = "on_start", ProcessStarted, "has started"

    def __init__(self, *, target_action: Any = None, on_start: Any, **kwargs: Any) -> None:
        super().__init__(target_action=target_action, entities=on_start, **kwargs)


class OnExecutionComplete(_OnAction):
    """When an action is done."""

    kind, event, verb = "on_completion", ExecutionComplete, "is done"

    def __init__(self, *, target_action: Any = None, on_completion: Any, **kwargs: Any) -> None:
        super().__init__(target_action=target_action, entities=on_completion, **kwargs)


class OnProcessIO(_OnAction):
    """When a process writes something."""

    kind, event, verb = "on_io", ProcessIO, "writes something"

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: Any = None,
        on_stdout: Any = None,
        on_stderr: Any = None,
        on_output: Any = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(target_action=target_action, **kwargs)
        self.on_stdout, self.on_stderr, self.on_output = on_stdout, on_stderr, on_output
        self.on_stdin = on_stdin

    def entities_for(self) -> Any:
        return self.handle

    def handle(self, event: Any, context: LaunchContext) -> Any:
        own = self.on_stdout if event.from_stdout else self.on_stderr
        done: list[Any] = []
        for function in (own, self.on_output):
            done += listed(function(event) if callable(function) else function)
        return done


class OnShutdown(EventHandler):
    """When the launch ends."""

    kind = "on_shutdown"

    def __init__(self, *, on_shutdown: Any, **kwargs: Any) -> None:
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown), entities=on_shutdown, **kwargs
        )

    @property
    def when(self) -> str:
        return "when the launch ends"


class OnIncludeLaunchDescription(EventHandler):
    """When a launch description is included: never said here."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(matcher=lambda _: False, **kwargs)


class OnStateTransition(EventHandler):
    """When a lifecycle node goes from a state to another."""

    kind = "on_state"

    def __init__(
        self,
        *,
        entities: Any,
        target_lifecycle_node: Any = None,
        transition: str | None = None,
        start_state: str | None = None,
        goal_state: str | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(matcher=self._is_it, entities=entities, **kwargs)
        self.target = target_lifecycle_node
        self.transition, self.start_state, self.goal_state = transition, start_state, goal_state

    def _is_it(self, event: Any) -> bool:
        if not isinstance(event, StateTransition):
            return False
        if self.target is not None and event.action is not self.target:
            return False
        wanted = (self.transition, self.start_state, self.goal_state)
        found = (event.transition, event.start_state, event.goal_state)
        return all(one is None or one == other for one, other in zip(wanted, found, strict=True))

    @property
    def when(self) -> str:
        which = self.goal_state or self.transition or "another state"
        return f"when {target_name(self.target)} reaches {which}"


def entities_of(entities: Any, event: Any, context: LaunchContext) -> list[Any]:
    """Return the actions of a handler: as given, or as its function gives them for an event."""
    return listed(entities(event, context) if callable(entities) else entities)


def listed(found: Any) -> list[Any]:
    """Return what a handler gives as a list: None, one action, or several."""
    if found is None:
        return []
    if isinstance(found, Iterable):
        return list(cast("Iterable[Any]", found))
    return [found]
