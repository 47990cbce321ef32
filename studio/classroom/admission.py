"""How others join: by a code, a link, perhaps a password, unless the class is locked."""

from __future__ import annotations

import asyncio
import hashlib
import hmac
import secrets
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Final

from studio.classroom.record import new_code, new_link
from studio.errors import NotJoiningError

if TYPE_CHECKING:
    from studio.classroom.record import ClassRecord
    from studio.protocol.classroom import JoinRole

_SALT_BYTES: Final = 16
_hashing: Final = ThreadPoolExecutor(max_workers=1, thread_name_prefix="passwords")
_SCRYPT: Final = {"n": 1 << 14, "r": 8, "p": 1}
"""Some 50 ms of a processor and 16 MiB: OWASP's least for scrypt."""


class Admission:
    """What somebody has to know to join; used on the event loop only."""

    def __init__(self, kept: ClassRecord) -> None:
        self.open, self.locked = kept.open, kept.locked
        self.code, self.link = kept.code, kept.link
        self.join_as: JoinRole = kept.join_as
        self.password = kept.password
        """Salt and hash in hex; empty: none."""

    def renew(self) -> None:
        """Make another code and link."""
        self.code, self.link = new_code(), new_link()

    async def set_password(self, password: str) -> None:
        """Ask for a password from now on; empty: for none."""
        if not password:
            self.password = ""
            return
        salt = secrets.token_bytes(_SALT_BYTES)
        self.password = f"{salt.hex()}.{await _hashed(password, salt)}"

    def knows_link(self, given: str) -> bool:
        """Whether this is the code of the link, which nobody guesses."""
        return self.open and _same(given, self.link)

    def check_code(self, given: str) -> None:
        """Pass if somebody with this code, or that of the link, may go on.

        Raises:
            NotJoiningError: The class is not open, it is locked, or the code is another one.
        """
        if not self.open:
            raise NotJoiningError("closed", "Nobody can join now: ask whoever leads the class.")
        typed = "".join(given.split()).replace("-", "").upper()
        is_code = _same(typed, self.code)
        if not (_same(given, self.link) or is_code):
            raise NotJoiningError("code", "That is not the code of this class: type it again.")
        if self.locked:
            raise NotJoiningError("locked", "The class is locked: ask for it to be opened.")

    async def check_password(self, given: str) -> None:
        """Pass if it is the password, or none is asked for.

        Raises:
            NotJoiningError: It is another one.
        """
        if not self.password:
            return
        salt, _, proof = self.password.partition(".")
        if not _same(await _hashed(given, bytes.fromhex(salt)), proof):
            raise NotJoiningError("password", "That is not the password: type it again.")


def _same(given: str, wanted: str) -> bool:
    return bool(wanted) and hmac.compare_digest(given.encode(), wanted.encode())


async def _hashed(password: str, salt: bytes) -> str:
    """Hash in a thread of its own: that of others shall not wait for a crowd that guesses."""

    def work() -> str:
        return hashlib.scrypt(password.encode(), salt=salt, **_SCRYPT).hex()

    return await asyncio.get_running_loop().run_in_executor(_hashing, work)
