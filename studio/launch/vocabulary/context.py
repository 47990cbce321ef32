"""LaunchContext: what is set while a launch file is visited."""

from __future__ import annotations

import os
from contextlib import contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Generator, Iterable

    from studio.launch.vocabulary.host import Host
    from studio.launch.vocabulary.texts import Substitution


class LaunchContext:
    """The arguments' values, the environment, and what an event's handler knows."""

    def __init__(
        self,
        host: Host | None = None,
        *,
        argv: Iterable[str] | None = None,
        noninteractive: bool = False,
    ) -> None:
        self._host = host or current_host()
        self.argv = list(argv or ())
        self.noninteractive = noninteractive
        self.launch_configurations: dict[str, Any] = {}
        self.locals: Any = SimpleNamespace()
        self.current_file = ""
        self.asyncio_loop: asyncio.AbstractEventLoop | None = None
        self._configurations: list[dict[str, Any]] = []
        self._environments: list[dict[str, str]] = []

    @property
    def host(self) -> Host:
        return self._host

    @property
    def environment(self) -> Any:
        """The environment that processes get."""
        return os.environ

    @property
    def global_parameters(self) -> list[tuple[str, Any]]:
        """What SetParameter and SetParametersFromFile set: (name, value), or ("", path)."""
        return self.launch_configurations.get("global_params", [])

    @property
    def is_shutdown(self) -> bool:
        return False

    def perform_substitution(self, substitution: Substitution) -> str:
        """Return the text of a substitution."""
        return substitution.perform(self)

    def extend_locals(self, extension: dict[str, Any]) -> None:
        for name, value in extension.items():
            setattr(self.locals, name, value)

    def extend_globals(self, extension: dict[str, Any]) -> None:
        self.extend_locals(extension)

    def get_locals_as_dict(self) -> dict[str, Any]:
        return dict(vars(self.locals))

    def register_event_handler(self, event_handler: Any, append: bool = False) -> None:
        event_handler.register(self)

    def unregister_event_handler(self, event_handler: Any) -> None:
        event_handler.unregister(self)

    def emit_event_sync(self, event: Any) -> None:
        self.host.emit(event, self)

    async def emit_event(self, event: Any) -> None:
        self.host.emit(event, self)

    def push(self) -> None:
        """Keep what is set, to come back to it by `pop`."""
        self._configurations.append(_copied(self.launch_configurations))
        self._environments.append(dict(os.environ))

    def pop(self) -> None:
        """Come back to what was kept."""
        self._come_back(self._configurations.pop())
        _set_environment(self._environments.pop())

    _push_launch_configurations = push
    _pop_launch_configurations = pop

    def _come_back(self, kept: dict[str, Any]) -> None:
        self.launch_configurations.clear()
        self.launch_configurations.update(kept)

    @contextmanager
    def in_file(self, path: str) -> Generator[None]:
        """Have a launch file be the current one."""
        before = self.current_file, vars(self.locals).get("current_launch_file_directory")
        self.current_file = path
        self.locals.current_launch_file_path = path
        self.locals.current_launch_file_directory = os.path.dirname(path)  # noqa: PTH120
        try:
            yield
        finally:
            self.current_file, self.locals.current_launch_file_directory = before
            self.locals.current_launch_file_path = self.current_file

    def snapshot(self) -> LaunchContext:
        """Return a context with the same settings, which later changes of this one leave alone."""
        other = LaunchContext(self.host, argv=self.argv)
        other.launch_configurations = _copied(self.launch_configurations)
        other.locals = SimpleNamespace(**vars(self.locals))
        other.current_file, other.asyncio_loop = self.current_file, self.asyncio_loop
        return other


def _copied(configurations: dict[str, Any]) -> dict[str, Any]:
    return {
        name: list(value) if isinstance(value, list) else value  # pyright: ignore[reportUnknownArgumentType]
        for name, value in configurations.items()
    }


def _set_environment(kept: dict[str, str]) -> None:
    for name in set(os.environ) - set(kept):
        del os.environ[name]
    os.environ.update(kept)


_HOSTS: list[Host] = []


def use_host(host: Host) -> None:
    """Have all contexts and placeholders of this process belong to a host."""
    _HOSTS[:] = [host]


def current_host() -> Host:
    """Return the host of this process."""
    return _HOSTS[-1]
