"""What actions ask of the one who plans or runs them: texts are known, nothing has begun."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from studio.launch.plan import Where

if TYPE_CHECKING:
    from collections.abc import Callable


@dataclass(slots=True)
class ParameterSet:
    """Parameters in the order given: those of a dict, or of a file.

    Attributes:
        values: Names and values; of a file None.
        path: Of the file, empty for a dict.
    """

    values: dict[str, Any] | None = None
    path: str = ""


@dataclass(slots=True)
class Request:
    """A node or command that is to run.

    Attributes:
        action: What asks for it; events name it.
        kind: `node`, `lifecycle`, `container`, `composable` or `process`.
        command: Of a process; a shell's is one text.
        label: The process's name where the launch file gives it: `exec_name` of a node.
        environment: What is set beside the launch's own environment.
        retries: How often it is started again at most; negative: without end.
        on_exit: Called, or walked, when it has ended for good.
    """

    action: Any
    kind: str
    where: Where = field(default_factory=Where)
    package: str = ""
    executable: str = ""
    label: str = ""
    name: str = ""
    namespace: str = "/"
    full_name: str = ""
    parameters: list[ParameterSet] = field(default_factory=list[ParameterSet])
    global_parameters: list[tuple[str, Any]] = field(default_factory=list[tuple[str, Any]])
    remaps: list[tuple[str, str]] = field(default_factory=list[tuple[str, str]])
    arguments: list[str] = field(default_factory=list[str])
    ros_arguments: list[str] = field(default_factory=list[str])
    container: str = ""
    command: list[str] = field(default_factory=list[str])
    prefix: list[str] = field(default_factory=list[str])
    shell: bool = False
    cwd: str = ""
    environment: dict[str, str] = field(default_factory=dict[str, str])
    output: str = "log"
    respawn: bool = False
    respawn_delay_s: float = 0.0
    retries: int = -1
    sigterm_timeout_s: float = 5.0
    sigkill_timeout_s: float = 5.0
    on_exit: Any = None


@dataclass(slots=True)
class Later:
    """What is to be done when something happens.

    Attributes:
        kind: As `Happening.kind` of the plan.
        when: Half a sentence.
        entities: The actions; a function that gives them, called with the event and the context.
        matches: Whether an event is the one.
        period_s: Of a timer; None: no timer.
    """

    kind: str
    when: str
    entities: Any
    matches: Callable[[Any], bool] | None = None
    period_s: float | None = None
    where: Where = field(default_factory=Where)
    once: bool = False
