"""Proofs of a role: a token in the printed address, a cookie from then on."""

from __future__ import annotations

import hmac
import os
import secrets
import stat
from typing import TYPE_CHECKING, Final

from studio.errors import DataFolderError, UnsafeKeyError
from studio.files import write_whole
from studio.protocol.roles import Role, Visitor

if TYPE_CHECKING:
    from pathlib import Path

_KEY_FILE = "cookie.key"
_KEY_BYTES = 32
_KEY_LIFE_S = 24 * 3600.0
_OTHERS = stat.S_IRWXG | stat.S_IRWXO


def new_token() -> str:
    """Return a presenter's token, fresh for every start."""
    return secrets.token_urlsafe(24)


_ROLES: Final = (Role.PRESENTER, Role.GUEST)
"""Of tokens and cookies that prove a role by themselves; helpers and students are in the class."""


class Credentials:
    """Tokens, cookies and one-time codes.

    The presenter's `token` is fresh for every start. The cookies' key is kept for a day, so that a
    page that was open when the studio was restarted comes back by itself; `revoke` ends all
    cookies before. With `guests`, whoever reaches the port may look, without a token.
    """

    def __init__(
        self, token: str, key: bytes, key_folder: Path | None = None, *, guests: bool = False
    ) -> None:
        self.token, self.guests = token, guests
        self._key, self._key_folder = key, key_folder
        self._codes: set[str] = set()

    def token_of(self, role: Role) -> str:
        """Return the token for an address; the guest's does not reveal the presenter's."""
        if role is Role.PRESENTER or not self.token:
            return self.token
        return _sign(self.token.encode(), role.value)

    def role_of_token(self, given: str) -> Role | None:
        """Return the role of this token; None if it is not valid."""
        return _match(given, {role: self.token_of(role) for role in _ROLES})

    def new_code(self) -> str:
        """Return a code that makes a presenter of the first who shows it, and of nobody else."""
        code = secrets.token_urlsafe(24)
        self._codes.add(code)
        return code

    def redeem(self, code: str) -> Role | None:
        """Return the role that a one-time code gives, once."""
        if code not in self._codes:
            return None
        self._codes.discard(code)
        return Role.PRESENTER

    def cookie_of(self, role: Role) -> str:
        """Return the value of a new cookie: who has it is a person, apart from all others."""
        person = secrets.token_hex(8)
        return f"{person}.{self._signed(role, person)}"

    def visitor_of_cookie(self, given: str) -> Visitor | None:
        """Return the person of this cookie; None if it is not valid."""
        person, _, proof = given.partition(".")
        role = _match(proof, {role: self._signed(role, person) for role in _ROLES})
        return Visitor(role, person) if role else None

    def revoke(self) -> None:
        """Make all cookies invalid that were ever given.

        Raises:
            DataFolderError: The new key cannot be written; the cookies are invalid all the same,
                until the studio is started again.
        """
        self._key = secrets.token_bytes(_KEY_BYTES)
        if self._key_folder is None:
            return
        try:
            write_whole(self._key_folder / _KEY_FILE, self._key, mode=0o600)
        except OSError as error:
            raise _unusable(self._key_folder, error) from error

    def _signed(self, role: Role, person: str) -> str:
        return _sign(self._key, f"{role.value} {person}")


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
    """Return the key of the last day's cookies, or a new one; a file that only its owner may read.

    Args:
        data_folder: Where `cookie.key` lives.
        now_s: Seconds since the epoch.

    Raises:
        DataFolderError: The file cannot be read or written.
        UnsafeKeyError: Others may know the key, or gave it.
    """
    path = data_folder / _KEY_FILE
    try:
        kept = _kept_key(path, now_s)
        if kept is not None:
            return kept
        key = secrets.token_bytes(_KEY_BYTES)
        write_whole(path, key, mode=0o600)  # whole: two studios may start at once
    except OSError as error:
        raise _unusable(data_folder, error) from error
    return key


def _kept_key(path: Path, now_s: float) -> bytes | None:
    """Return the key in the file; None when there is none, or one that is too old or broken."""
    try:
        descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0))
    except FileNotFoundError:
        return None
    with os.fdopen(descriptor, "rb") as file:
        status = os.fstat(descriptor)
        if os.name == "posix":
            _check_owner(path, status)
        kept = file.read(_KEY_BYTES + 1)
    is_young = abs(now_s - status.st_mtime) < _KEY_LIFE_S  # the clock may have been set back
    return kept if is_young and len(kept) == _KEY_BYTES else None


def _check_owner(path: Path, status: os.stat_result) -> None:
    """Pass, or refuse a key that others may have read or written."""
    if status.st_uid != os.geteuid():
        raise UnsafeKeyError(str(path), "belongs to another user")
    if status.st_mode & _OTHERS:
        raise UnsafeKeyError(str(path), "can be read or written by other users")


def _unusable(folder: Path, error: OSError) -> DataFolderError:
    return DataFolderError(str(folder), error.strerror or "not readable")
