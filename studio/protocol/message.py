"""The bases of all messages between page and studio: frozen, and nothing unknown in them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, TypeAlias, TypeVar, Union

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints, TypeAdapter

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator


class Message(BaseModel):
    """One message; unknown fields are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid")


OFFSET_LIMIT: Final = 1 << 32
"""More than the length of any file that can be opened."""


def _without_nul(name: str) -> str:
    if "\0" in name:
        raise ValueError("No name has a NUL in it.")
    return name


ArgumentName: TypeAlias = Annotated[
    str, StringConstraints(min_length=1, max_length=200), AfterValidator(_without_nul)
]
"""Name of an `xacro:arg` that can be passed as `name:=value`, and written to a file."""


class Command(Message, allow_inf_nan=False):
    """What a browser asks for; each has a `type` of its own."""

    request: int = 0
    """Chosen by the browser; the answer repeats it."""
    document: str = ""
    """Id of the open document; empty for commands that need none."""
    id: Annotated[str, StringConstraints(max_length=64)] = ""
    """Chosen by the browser: commands with the same one, of the same person, run once."""


class Event(Message):
    """What the studio sends; each has a `type` of its own."""

    is_moment: ClassVar[bool] = False
    """Whether it tells what happened just now, which a page that comes later is not told."""


_Kind = TypeVar("_Kind", bound=Command | Event)


def type_of(kind: type[Command | Event]) -> str:
    """Return the `type` that all messages of one kind carry."""
    return kind.model_fields["type"].default


def adapter_of(kinds: Iterable[type[_Kind]]) -> TypeAdapter[_Kind]:
    """Return a parser of these kinds, which are distinguished by their `type`."""
    union: Any = Union[tuple(sorted(kinds, key=type_of))]  # noqa: UP007 - a tuple of run time
    discriminated: Any = Annotated[union, Field(discriminator="type")]
    return TypeAdapter(discriminated)


def all_events() -> set[type[Event]]:
    """Return every kind of event that was defined."""
    return {kind for kind in _below(Event) if "type" in kind.model_fields}


def _below(kind: type[Event]) -> Iterator[type[Event]]:
    for one in kind.__subclasses__():
        yield one
        yield from _below(one)
