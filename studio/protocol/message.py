"""The base of every message between page and studio: frozen, and nothing unknown in it."""

from __future__ import annotations

from typing import Annotated, Final, TypeAlias

from pydantic import AfterValidator, BaseModel, ConfigDict, StringConstraints


class Message(BaseModel):
    """One message; unknown fields are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")


OFFSET_LIMIT: Final = 1 << 32
"""More than any file that is opened is long."""


def _without_nul(name: str) -> str:
    if "\0" in name:
        raise ValueError("No name has a NUL in it.")
    return name


ArgumentName: TypeAlias = Annotated[
    str, StringConstraints(min_length=1, max_length=200), AfterValidator(_without_nul)
]
"""Of an `xacro:arg`: what can be passed as `name:=value`, and written down in a file."""


class CommandMessage(Message, allow_inf_nan=False):
    """What every command carries."""

    request: int = 0
    """Chosen by the browser; the answer repeats it."""
    document: str = ""
    """Id of the open document; empty for commands that need none."""
