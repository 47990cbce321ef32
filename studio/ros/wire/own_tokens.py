"""Own tokens: what a session itself shows, known at once and not only when it comes back to it."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

from studio.ros.wire.zenoh import declare_token

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.wire.zenoh import Declaration, Session


class OwnTokens:
    """Shows tokens of a session, and tells those who follow which come and go; thread-safe."""

    def __init__(self, zenoh: Session) -> None:
        self._zenoh = zenoh
        self._lock = threading.Lock()
        self._tokens: dict[str, None] = {}
        self._listeners: tuple[Callable[[str, bool], None], ...] = ()

    def __contains__(self, token: str) -> bool:
        return token in self._tokens

    def show(self, token: str) -> ShownToken:
        """Show a token to all who watch, those of this session first."""
        declared = declare_token(self._zenoh, token)
        with self._lock:
            self._tokens[token] = None
            listeners = self._listeners
        for listener in listeners:
            listener(token, True)  # noqa: FBT003
        return ShownToken(declared, lambda: self._withdraw(token))

    def follow(self, listener: Callable[[str, bool], None]) -> Callable[[], None]:
        """Call a listener with each token and whether it is shown; return what ends that.

        It is called with those that are shown now before this returns, with one perhaps twice.
        """
        with self._lock:
            self._listeners = (*self._listeners, listener)
            tokens = list(self._tokens)
        for token in tokens:
            listener(token, True)  # noqa: FBT003
        for token in tokens:
            if token not in self._tokens:  # withdrawn by another thread meanwhile
                listener(token, False)  # noqa: FBT003
        return lambda: self._leave(listener)

    def _withdraw(self, token: str) -> None:
        with self._lock:
            self._tokens.pop(token, None)
            listeners = self._listeners
        for listener in listeners:
            listener(token, False)  # noqa: FBT003

    def _leave(self, listener: Callable[[str, bool], None]) -> None:
        with self._lock:
            self._listeners = tuple(one for one in self._listeners if one != listener)


class ShownToken:
    """A token that is shown until it is undeclared."""

    def __init__(self, declared: Declaration, withdraw: Callable[[], None]) -> None:
        self._declared, self._withdraw = declared, withdraw

    def undeclare(self) -> None:
        """Take it back; a second time is an error of Zenoh's."""
        self._withdraw()
        self._declared.undeclare()
