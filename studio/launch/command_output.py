"""What a command prints that a launch file asks for while it runs: `Command([...])`."""

from __future__ import annotations

import contextlib
import os
import selectors
import shlex
import signal
import subprocess
import threading
import time
from typing import TYPE_CHECKING, Final

from studio.errors import StudioError, SubstitutionFailure

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.packages.index import PackageIndex

TIMEOUT_S: Final = 60.0
OUTPUT_MAX_BYTES: Final = 16 << 20
_ERRORS_MAX_BYTES: Final = 64 << 10
_SHOWN: Final = 1_500
_LOOK_EVERY_S: Final = 0.1


class CommandOutput:
    """Runs one command after the other, each with bounds.

    Args:
        index: The packages, whose xacro files a command may name.
        asking: The launch file.
    """

    def __init__(self, index: PackageIndex, asking: Path) -> None:
        self._index, self._asking = index, asking
        self._ended = threading.Event()

    def end(self) -> None:
        """End the command that runs; may be called on any thread."""
        self._ended.set()

    def of(self, line: str) -> tuple[str, str]:
        """Run a command; returns what it printed, and the end of what it printed to stderr.

        Raises:
            SubstitutionFailure: It cannot be run, fails, prints too much or takes too long.
        """
        try:
            words = shlex.split(line)
        except ValueError as error:
            raise SubstitutionFailure(f"the command {line!r} is none ({error})") from None
        command, environment = self._program_of(words)
        self._ended.clear()
        try:
            code, printed, errors = self._run(line, command, {**os.environ, **environment})
        except OSError as error:
            raise SubstitutionFailure(f"the command {line!r} was not run: {error}") from None
        if code:
            raise SubstitutionFailure(
                f"executed command failed. Command: {line} (exit code {code}): {errors[-_SHOWN:]}"
            )
        return printed, errors[-_SHOWN:]

    def _run(
        self, line: str, command: list[str], environment: Mapping[str, str]
    ) -> tuple[int, str, str]:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment,
            start_new_session=True,
        )
        try:
            printed, errors = self._read(line, process)
            return process.wait(), printed.decode(errors="replace"), errors
        finally:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            for stream in (process.stdout, process.stderr):
                if stream is not None:
                    stream.close()

    def _read(self, line: str, process: subprocess.Popen[bytes]) -> tuple[bytes, str]:
        """Read both streams to their end, which is that of all that hold them, or of the command.

        Raises:
            SubstitutionFailure: It prints too much, takes too long, or the launch ends.
        """
        assert process.stdout is not None
        assert process.stderr is not None
        printed, errors = bytearray(), bytearray()
        until = time.monotonic() + TIMEOUT_S
        with selectors.DefaultSelector() as selector:
            selector.register(process.stdout, selectors.EVENT_READ, printed)
            selector.register(process.stderr, selectors.EVENT_READ, errors)
            while selector.get_map():
                found = selector.select(_LOOK_EVERY_S)
                for key, _ in found:
                    data = os.read(key.fd, 1 << 16)
                    key.data.extend(data)
                    if not data:
                        selector.unregister(key.fileobj)
                del errors[:-_ERRORS_MAX_BYTES]
                if len(printed) > OUTPUT_MAX_BYTES:
                    raise SubstitutionFailure(
                        f"the command {line!r} prints more than {OUTPUT_MAX_BYTES >> 20} MB: it "
                        "was ended"
                    )
                if time.monotonic() > until:
                    raise SubstitutionFailure(
                        f"the command {line!r} takes longer than {TIMEOUT_S:g} s: it was ended"
                    )
                if self._ended.is_set():
                    raise SubstitutionFailure(f"the command {line!r} was ended with the launch")
                if not found and process.poll() is not None:  # a child of its own holds a pipe
                    break
        return bytes(printed), errors.decode(errors="replace").strip()

    def _program_of(self, words: list[str]) -> tuple[list[str], dict[str, str]]:
        from studio.packages.passing import environment_of  # noqa: PLC0415
        from studio.programs.finding import command_program  # noqa: PLC0415

        if not words:
            raise SubstitutionFailure("a command is empty: name the program")
        try:
            program = command_program(self._index, words)
        except StudioError as error:
            raise SubstitutionFailure(str(error)) from None
        if program is None:
            return words, {}
        command = list(program.command)
        if os.path.basename(words[0]) == "xacro":  # noqa: PTH119 - a word
            command[5:5] = [
                word for folder in self._package_paths() for word in ("--package-path", folder)
            ]
        return command, {**environment_of(self._index, self._asking), **dict(program.environment)}

    def _package_paths(self) -> list[str]:
        return sorted({str(one.folder.parent) for one in self._index.packages[:200]})[:20]
