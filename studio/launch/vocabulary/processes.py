"""ExecuteProcess and its like: commands of a launch file."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from studio.launch.vocabulary.actions import Action
from studio.launch.vocabulary.requests import Request
from studio.launch.vocabulary.texts import (
    SomeText,
    as_bool,
    as_float,
    described,
    perform,
    to_texts,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.launch.vocabulary.context import LaunchContext


class Executable:
    """A command with its folder and environment."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeText],
        prefix: SomeText | None = None,
        name: SomeText | None = None,
        cwd: SomeText | None = None,
        env: Mapping[Any, Any] | None = None,
        additional_env: Mapping[Any, Any] | None = None,
        arguments: Iterable[SomeText] | None = None,
        **_: Any,
    ) -> None:
        words = [cmd] if isinstance(cmd, str) else [*cmd, *(arguments or ())]
        self.cmd = [to_texts(one) for one in words]
        self.prefix, self.name, self.cwd = prefix, name, cwd
        self.env, self.additional_env = env, additional_env

    def environment(self, context: LaunchContext) -> dict[str, str]:
        """Return what is set beside the launch's own environment."""
        given = [*(self.env or {}).items(), *(self.additional_env or {}).items()]
        return {perform(context, name): perform(context, value) for name, value in given}


class ExecuteLocal(Action):
    """Runs a command."""

    kind = "process"

    def __init__(
        self,
        *,
        process_description: Executable,
        shell: Any = False,
        sigterm_timeout: Any = "5",
        sigkill_timeout: Any = "5",
        emulate_tty: Any = False,
        output: Any = "log",
        output_format: str = "",
        cached_output: Any = False,
        log_cmd: Any = False,
        on_exit: Any = None,
        respawn: Any = False,
        respawn_delay: Any = None,
        respawn_max_retries: Any = -1,
        condition: Any = None,
    ) -> None:
        super().__init__(condition=condition)
        self.process_description = process_description
        self.shell, self.output, self.on_exit = shell, output, on_exit
        self.respawn, self.respawn_delay = respawn, respawn_delay
        self.respawn_max_retries = respawn_max_retries
        self.sigterm_timeout, self.sigkill_timeout = sigterm_timeout, sigkill_timeout
        self.process_details: dict[str, Any] | None = None
        self.return_code: int | None = None

    @property
    def name(self) -> str | None:
        return (self.process_details or {}).get("name")

    @property
    def cmd(self) -> list[Any]:
        return cast("list[Any]", self.process_description.cmd)

    def shown_name(self) -> str:
        """Name it for a reader."""
        name = self.process_description.name
        if name is not None:
            return described(name)
        words = [described(one) for one in self.process_description.cmd]
        text = " ".join(words)
        return text if len(text) <= 60 else f"{text[:57]}..."

    def describe(self) -> str:
        return f"run {self.shown_name()}"

    def execute(self, context: LaunchContext) -> Any:
        context.host.start(self.request(context), context)

    def get_asyncio_future(self) -> None:
        return None

    def common(self, context: LaunchContext, kind: str) -> Request:
        """Return a request with all that nodes and commands share."""
        one = self.process_description
        prefix = perform(context, one.prefix) if one.prefix is not None else ""
        prefix = prefix or str(context.launch_configurations.get("launch-prefix", ""))
        label = "" if one.name is None else perform(context, one.name)
        delay = 0.0 if self.respawn_delay is None else as_float(context, self.respawn_delay)
        return Request(
            self,
            kind,
            self.where,
            label=label,
            name=label,
            prefix=shlex.split(prefix),
            shell=as_bool(context, self.shell, "shell"),
            cwd="" if one.cwd is None else perform(context, one.cwd),
            environment=one.environment(context),
            output=_output_of(context, self.output),
            respawn=as_bool(context, self.respawn, "respawn"),
            respawn_delay_s=delay,
            retries=int(as_float(context, self.respawn_max_retries)),
            sigterm_timeout_s=as_float(context, self.sigterm_timeout),
            sigkill_timeout_s=as_float(context, self.sigkill_timeout),
            on_exit=self.on_exit,
        )

    def request(self, context: LaunchContext) -> Request:
        """Return what is to run.

        Raises:
            SubstitutionFailure: A text of it is not known.
        """
        request = self.common(context, self.kind)
        request.command = [perform(context, one) for one in self.process_description.cmd]
        if not request.command:
            raise ValueError("cmd is empty: name the program")
        request.name = request.name or Path(_first_word(request)).name
        return request


def _first_word(request: Request) -> str:
    words = request.command[0].split() if request.shell else request.command
    return words[0] if words else ""


def _output_of(context: LaunchContext, output: Any) -> str:
    if isinstance(output, dict):
        return ", ".join(f"{k}: {v}" for k, v in cast("dict[Any, Any]", output).items())
    return perform(context, output)


class ExecuteProcess(ExecuteLocal):
    """Runs a command, given by its words."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeText],
        prefix: SomeText | None = None,
        name: SomeText | None = None,
        cwd: SomeText | None = None,
        env: Mapping[Any, Any] | None = None,
        additional_env: Mapping[Any, Any] | None = None,
        **kwargs: Any,
    ) -> None:
        described_one = Executable(
            cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env
        )
        super().__init__(process_description=described_one, **kwargs)


class ExecuteLocalExt(ExecuteLocal):
    """As ExecuteLocal."""
