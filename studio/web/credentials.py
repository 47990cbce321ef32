"""What proves a role: a token in the printed address, a cookie from then on."""

from __future__ import annotations

import hmac
import os
import secrets
from dataclasses import dataclass
from typing import TYPE_CHECKING

from studio.engine.roles import Role
from studio.errors import DataFolderError

if TYPE_CHECKING:
    from pathlib import Path

_KEY_FILE = "cookie.key"
_KEY_BYTES = 32
_KEY_LIFE_S = 24 * 3600.0


def new_token() -> str:
    """A presenter's token, fresh for every start."""
    return secrets.token_urlsafe(24)


@dataclass(frozen=True, slots=True, repr=False)
class Credentials:
    """Tokens and cookies of both roles.

    The presenter's `token` is fresh for every start. `cookie_key` is kept for a day, so that a page
    that was open when the studio was started anew comes back by itself. `token` None: nobody is
    asked, everyone who reaches the port is a presenter.
    """

    token: str | None
    cookie_key: bytes

    def token_of(self, role: Role) -> str | None:
        """The token that an address carries; the viewer's does not betray the presenter's."""
        if self.token is None or role is Role.PRESENTER:
            return self.token
        return _sign(self.token.encode(), role.value)

    def cookie_of(self, role: Role) -> str:
        """The cookie's value."""
        return _sign(self.cookie_key, role.value)

    def role_of_token(self, given: str) -> Role | None:
        """Whose token this is."""
        return _match(given, {role: self.token_of(role) or "" for role in Role})

    def role_of_cookie(self, given: str) -> Role | None:
        """Whose cookie this is."""
        return _match(given, {role: self.cookie_of(role) for role in Role})


def _sign(key: bytes, message: str) -> str:
    return hmac.new(key, message.encode(), "sha256").hexdigest()


def _match(given: str, proofs: dict[Role, str]) -> Role | None:
    """Compare with every proof in constant time; an empty one matches nothing."""
    found: Role | None = None
    for role, proof in proofs.items():
        if hmac.compare_digest(given.encode(), proof.encode()) and proof:
            found = role
    return found


def cookie_key(data_folder: Path, now_s: float) -> bytes:
    """The key of the last day's cookies, or a new one; a file that only its owner may read.

    Args:
        data_folder: Where `cookie.key` lives.
        now_s: Seconds since the epoch.

    Raises:
        DataFolderError: The file cannot be read or written.
    """
    path = data_folder / _KEY_FILE
    try:
        if path.is_file() and 0 <= now_s - path.stat().st_mtime < _KEY_LIFE_S:
            kept = path.read_bytes()
            if len(kept) == _KEY_BYTES:
                return kept
        return _write_new_key(path)
    except OSError as error:
        raise DataFolderError(str(data_folder), error.strerror or "not readable") from error


def _write_new_key(path: Path) -> bytes:
    """Write beside it and rename: two studios that start at once never read half a key."""
    key = secrets.token_bytes(_KEY_BYTES)
    draft = path.with_name(f"{path.name}.{os.getpid()}")
    descriptor = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
    with os.fdopen(descriptor, "wb") as file:
        file.write(key)
    draft.replace(path)
    return key
