"""DemoProcesses: demos in processes of their own, which end with the one that started them."""

from __future__ import annotations

import os
import subprocess
import time
from typing import TYPE_CHECKING, Self

from studio.ros.wire.settings import environment_for
from studio.system import python_command

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from studio.ros.wire.settings import WireSettings

BY_ITSELF_S = 0.6
"""So long a process may take to end by the Ctrl-C that the terminal sent it, too."""
AFTER_SIGNAL_S = 1.0
LEASHED = "studio.course.leashed"
"""Runs the module that is its first argument for as long as its input stays open."""


class DemoProcesses:
    """Processes started one by one and ended together, within two seconds."""

    def __init__(self, environment: Mapping[str, str] = os.environ) -> None:
        self._environment = dict(environment)
        self._processes: list[subprocess.Popen[bytes]] = []

    @classmethod
    def at(cls, settings: WireSettings) -> Self:
        """Return processes that all join the same routers and domain."""
        return cls(environment_for(settings))

    def start(self, module: str, arguments: Iterable[str] = ()) -> None:
        """Run a module, none of the folder we are in; what it prints comes out where ours does."""
        command = python_command(module, *arguments)
        self._processes.append(subprocess.Popen(command, env=self._environment))

    def start_leashed(self, module: str, arguments: Iterable[str] = ()) -> None:
        """Run a module that ends with this process, however that ends; no key reaches it."""
        command = python_command(LEASHED, module, *arguments)
        self._processes.append(
            subprocess.Popen(command, env=self._environment, stdin=subprocess.PIPE)
        )

    def wait(self) -> int:
        """Wait until all have ended; gives the first exit code that is not 0."""
        codes = [process.wait() for process in self._processes]
        return next((code for code in codes if code), 0)

    def end(self) -> None:
        """End those that still run: after a wait they are terminated, then killed."""
        for process in self._processes:
            if process.stdin is not None:
                process.stdin.close()
        self._all_ended_within(BY_ITSELF_S)
        self._terminate()
        if not self._all_ended_within(AFTER_SIGNAL_S):
            for process in self._running():
                process.kill()
                process.wait()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def _terminate(self) -> None:
        for process in self._running():
            process.terminate()

    def _running(self) -> list[subprocess.Popen[bytes]]:
        return [process for process in self._processes if process.poll() is None]

    def _all_ended_within(self, patience_s: float) -> bool:
        end_s = time.monotonic() + patience_s
        for process in self._processes:
            try:
                process.wait(max(0.0, end_s - time.monotonic()))
            except subprocess.TimeoutExpired:
                return False
        return True


def rover_call(package: Path, arguments: Mapping[str, str], router: str) -> tuple[str, list[str]]:
    """Return the rover's module and its arguments, for a copy of its package and `arguments`."""
    file = package / "urdf" / "rover.urdf.xacro"
    mapping = [f"{name}:={value}" for name, value in arguments.items()]
    return "studio.course.rover", [str(file), *mapping, "--router", router]
