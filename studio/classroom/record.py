"""The file of a class: it comes back as it was when the studio was killed and started again."""

from __future__ import annotations

import asyncio
import logging
import secrets
from typing import TYPE_CHECKING, Final, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from studio.errors import DataFolderError
from studio.files import write_whole
from studio.protocol.classroom import JoinRole

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

_LETTERS: Final = "ABCDEFGHJKMNPQRSTVWXYZ"
"""Without those that look like a digit or like another letter."""
_CODE_LETTERS: Final = 6
_log = logging.getLogger(__name__)


def new_code() -> str:
    """Return six letters that are easily read from a projector and typed."""
    return "".join(secrets.choice(_LETTERS) for _ in range(_CODE_LETTERS))


def new_link() -> str:
    """Return the longer code that is in the link and the QR code, which nobody types."""
    return secrets.token_urlsafe(12)


class _Kept(BaseModel):
    model_config = ConfigDict(frozen=True, extra="ignore")


class MemberRecord(_Kept):
    """What is kept of a person: their name and what they are here."""

    person: str
    name: str
    role: Literal["helper", "student", "guest"]
    removed: bool = False
    ticks: dict[str, float] = Field(default_factory=dict)
    """When steps of lessons were done, in seconds since the epoch, by `lesson/step`."""


class NodesRecord(_Kept):
    """Students' own nodes: what the pool is made from; without a secret, access is off."""

    secret: str = Field(default="", pattern=r"^([0-9a-f]{64})?$")
    domains: tuple[int, ...] = ()
    port: int = 0
    given: dict[str, int] = Field(default_factory=dict)
    """The domains, by person."""
    revoked: tuple[int, ...] = ()
    """Domains of those who were sent out."""


class ClassRecord(_Kept):
    """What is kept of a class."""

    open: bool = False
    code: str = Field(default_factory=new_code, pattern=r"^[A-Z]{6}$")
    link: str = Field(default_factory=new_link, min_length=16)
    locked: bool = False
    password: str = Field(default="", pattern=r"^([0-9a-f]{32}\.[0-9a-f]{128})?$")
    """Salt and hash (scrypt), in hex; empty: none is asked for."""
    join_as: JoinRole = "student"
    key: str = Field(default_factory=lambda: secrets.token_hex(32), pattern=r"^[0-9a-f]{64}$")
    """Signs the members' cookies, in hex."""
    room: str = Field(default_factory=lambda: secrets.token_hex(32), pattern=r"^[0-9a-f]{64}$")
    """Makes the identity by which relays know the room again, in hex."""
    relays: tuple[str, ...] = ()
    """Lines of the relays that a presenter added."""
    members: tuple[MemberRecord, ...] = ()
    nodes: NodesRecord = NodesRecord()
    ticks: dict[str, float] = Field(default_factory=dict)
    """What the presenter has done of lessons."""


class ClassFile:
    """Keeps the record where only the owner may read it; `path` None keeps nothing."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._asked = self._kept = 0
        self._lock = asyncio.Lock()

    def read(self) -> ClassRecord:
        """Return the class of the last run; a new one if there was none, or it cannot be read."""
        if self._path is None:
            return ClassRecord()
        try:
            return ClassRecord.model_validate_json(self._path.read_bytes())
        except FileNotFoundError:
            return ClassRecord()
        except (OSError, ValidationError) as error:
            _log.warning("The class in %s cannot be read, and begins anew: %s", self._path, error)
            return ClassRecord()

    async def keep(self, record: Callable[[], ClassRecord]) -> None:
        """Write what `record` gives; what many ask for at once is written once.

        Raises:
            DataFolderError: The disk refuses it.
        """
        if self._path is None:
            return
        self._asked += 1
        mine = self._asked
        async with self._lock:
            if self._kept >= mine:
                return
            newest, data = self._asked, record().model_dump_json().encode()
            try:
                await asyncio.to_thread(write_whole, self._path, data, mode=0o600)
            except OSError as error:
                raise DataFolderError(str(self._path), error.strerror or "not writable") from error
            self._kept = newest

    async def delete(self) -> None:
        """Remove the file.

        Raises:
            DataFolderError: The disk refuses it.
        """
        if self._path is None:
            return
        async with self._lock:
            try:
                await asyncio.to_thread(self._path.unlink, missing_ok=True)
            except OSError as error:
                raise DataFolderError(str(self._path), error.strerror or "not writable") from error
