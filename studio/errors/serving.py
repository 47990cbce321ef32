"""Errors of workers, and of what browsers ask."""

from __future__ import annotations

from studio.errors.root import StudioError


class WorkerError(StudioError):
    """A worker process did not answer."""


class WorkerTimeoutError(WorkerError):
    """A worker did not answer in time and was ended."""

    def __init__(self, worker: str, timeout_s: float) -> None:
        super().__init__(
            f"The {worker} worker gave no answer within {timeout_s:g} s and was restarted."
        )
        self.worker, self.timeout_s = worker, timeout_s


class WorkerDiedError(WorkerError):
    """A worker ended in the middle of a request."""

    def __init__(self, worker: str, exit_code: int | None) -> None:
        super().__init__(f"The {worker} worker ended (exit code {exit_code}) and was restarted.")
        self.worker, self.exit_code = worker, exit_code


class AccessError(StudioError):
    """Somebody asked for what is not theirs."""


class NotAllowedError(AccessError):
    """The role may not do this."""

    def __init__(self, role: str, command: str) -> None:
        super().__init__(f"A {role} may not {command.replace('_', ' ')}: ask the presenter.")
        self.role, self.command = role, command


class UnknownLaneError(AccessError):
    """A bulk lane was asked for with a key of no open data lane."""

    def __init__(self) -> None:
        super().__init__("No open data lane has this key: ask for one on your data lane.")


class CommandError(StudioError):
    """A command of the browser is malformed or names what does not exist."""


class UnknownDocumentError(CommandError):
    """No open document has that id."""

    def __init__(self, document: str) -> None:
        super().__init__(f'No document "{document}" is open: open its file again.')
        self.document = document


class SupersededError(CommandError):
    """A question waited, and newer ones took its place."""

    def __init__(self) -> None:
        super().__init__("Newer questions came before this one was answered: ask again.")
