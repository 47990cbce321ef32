"""The process of the students' router: what they send never waits with the robot's own.

It is a worker (`studio.workers`): asked to open, then now and then whether it is well.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.errors import RouterNotStartedError
from studio.ros.wire.credentials import Credentials  # noqa: TC001 - msgspec reads it
from studio.worker_process import Codec, serve

if TYPE_CHECKING:
    from studio.ros.wire.router import EmbeddedRouter

MEMORY_BYTES: Final = 1 << 30
"""Of addresses; it takes about 40 MB."""


@dataclass(frozen=True, slots=True)
class OpenRouter:
    """Listen at the first of the endpoints that is free; `users` are names and their domains."""

    endpoints: tuple[str, ...]
    credentials: Credentials
    users: tuple[tuple[str, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class RouterOpen:
    """It listens; `reason`: why it does not, else empty."""

    endpoint: str = ""
    reason: str = ""


@dataclass(frozen=True, slots=True)
class AskWell:
    """Answer, if you can."""


@dataclass(frozen=True, slots=True)
class Well:
    """All is well."""


CODEC: Final = Codec(OpenRouter, RouterOpen, AskWell, Well)


class _Process:
    def __init__(self) -> None:
        self._router: EmbeddedRouter | None = None

    def handle(self, request: OpenRouter | AskWell) -> RouterOpen | Well:
        return self._open(request) if isinstance(request, OpenRouter) else Well()

    def close(self) -> None:
        if self._router is not None:
            self._router.close()

    def _open(self, request: OpenRouter) -> RouterOpen:
        from studio.ros.wire.endpoints import parse_endpoint  # noqa: PLC0415 - imports zenoh
        from studio.ros.wire.guarded import DomainUser, start_guarded_router  # noqa: PLC0415

        users = [DomainUser(name, domains) for name, domains in request.users]
        reason = ""
        for endpoint in request.endpoints:
            try:
                self._router = start_guarded_router(
                    parse_endpoint(endpoint), request.credentials, users
                )
            except RouterNotStartedError as error:
                reason = str(error)
                if not error.held:
                    break
            else:
                return RouterOpen(endpoint)
        return RouterOpen(reason=reason)


def main() -> None:
    """Answer until the studio is gone, and hang up on everybody."""
    process = _Process()
    try:
        serve(CODEC, process.handle, MEMORY_BYTES)
    finally:
        process.close()


if __name__ == "__main__":
    main()
