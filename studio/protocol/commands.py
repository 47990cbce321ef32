"""The registry of commands: each with who may send it, how large and how often, and what it does.

A room lists its commands beside the code that carries them out, as a web framework lists routes:

    COMMANDS = Commands[Lifecycle](Scope.ROS)
    COMMANDS.viewer(GetManaged, lambda nodes, c, _: nodes.managed(c))
    COMMANDS.controller(ChangeState, lambda nodes, c, _: nodes.change(c), needs_router=True)

`Commands.include` puts the parts of a whole together. The parser of commands, dispatch, access and
the page's types come from the whole.
"""

from __future__ import annotations

import asyncio
import time
from collections import OrderedDict
from dataclasses import dataclass
from enum import Enum, StrEnum, auto
from inspect import isawaitable
from typing import TYPE_CHECKING, Any, Final, Generic, TypeAlias, TypeVar

from studio.errors import CommandError, NotAllowedError, NotInControlError, UnknownDocumentError
from studio.protocol.message import Command, Event, type_of
from studio.protocol.roles import Role

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Iterator

    from studio.protocol.listeners import Listener
    from studio.protocol.roles import Person


COMMAND_LIMIT_BYTES: Final = 1 << 20
"""Limit of any command's JSON text."""

_RATES_MAX: Final = 10_000
"""Persons and commands that are counted, before those at rest are forgotten."""

_Command = TypeVar("_Command", bound=Command)
_Target = TypeVar("_Target")
_Part = TypeVar("_Part")
Answer: TypeAlias = Event | None
"""An event for the asker alone, sent before `done`; or none."""
Work: TypeAlias = "Callable[[_Target, _Command, Listener], Answer | Awaitable[Answer]]"
"""Carries a command out; gets what it is for, the command and who asks."""


class Scope(StrEnum):
    """What a command concerns."""

    DOCUMENT = "document"
    """One open document."""
    ROS = "ros"
    """The ROS system."""
    STUDIO = "studio"
    """The whole studio."""


@dataclass(frozen=True, slots=True)
class Permission:
    """Who may do one thing: send a command or one of viser's messages, or open a route."""

    name: str
    role: Role
    """The least role that may: what a guest may, everybody may."""
    scope: Scope = Scope.STUDIO
    needs_control: bool = False
    """Whether it is only for the one who has control."""


def may(person: Person | None, permission: Permission | None, document: str = "") -> bool:
    """Return whether a person may do something: the one question that every lane asks.

    Args:
        person: Who asks; None may do nothing.
        permission: Of what is asked; None: nobody may do it.
        document: Id of the document that it concerns, if any.
    """
    if person is None or permission is None or not person.role.includes(permission.role):
        return False
    if not person.sees(document):
        return False
    concerned = document if permission.scope is Scope.DOCUMENT else ""
    return not permission.needs_control or person.controls(concerned)


def demand(person: Person | None, permission: Permission | None, document: str = "") -> None:
    """Raise unless `may` allows it.

    Raises:
        NotAllowedError: No person of that role may.
        NotInControlError: Somebody else has control.
        UnknownDocumentError: It is a copy of somebody else's.
    """
    if may(person, permission, document):
        return
    name = permission.name if permission else "do this"
    if person and not person.sees(document):
        raise UnknownDocumentError(document)  # not even that there is one
    if person and permission and person.role.includes(permission.role):
        raise NotInControlError(person.role, name)
    raise NotAllowedError(person.role if person else "stranger", name)


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one command."""

    bytes_max: int = COMMAND_LIMIT_BYTES
    """Length of its JSON text."""
    per_second: float | None = None
    """Rate for one person, with bursts of one second's; None: without a limit."""


class OnCopies(Enum):
    """Whether a command can be carried out on a copy of a document."""

    ALLOWED = auto()
    WITHIN_ROOM = auto()
    """Only while the texts of the copy are not as large as they may be."""
    REFUSED = auto()
    """It writes files of the original, or adds to what the class sees."""


@dataclass(frozen=True, slots=True)
class CommandEntry(Generic[_Target]):
    """One command, and what carries it out."""

    permission: Permission
    message: type[Command]
    work: Work[_Target, Any]
    needs_router: bool
    """Whether it reaches other nodes: it is refused at once while the router is away."""
    limits: Limits
    on_copies: OnCopies = OnCopies.ALLOWED
    reviews: bool = False
    """Whether a presenter who sends it has seen what the texts are now."""
    same_for_all: bool = False
    """Whether all of one role are answered alike, so that a relay asks it once for many."""


class Commands(Generic[_Target]):
    """The commands that a part of the studio, or the whole, carries out.

    Args:
        scope: What they concern, unless an entry has its own.
    """

    def __init__(self, scope: Scope) -> None:
        self._scope = scope
        self._entries: dict[type[Command], CommandEntry[_Target]] = {}

    def __iter__(self) -> Iterator[CommandEntry[_Target]]:
        return iter(self._entries.values())

    def __getitem__(self, message: type[Command]) -> CommandEntry[_Target]:
        return self._entries[message]

    @property
    def messages(self) -> tuple[type[Command], ...]:
        """The message of each."""
        return tuple(self._entries)

    def viewer(
        self,
        message: type[_Command],
        work: Work[_Target, _Command],
        *,
        needs_router: bool = False,
        limits: Limits | None = None,
        same_for_all: bool = False,
    ) -> None:
        """Add a command that everybody may send who sees the page."""
        permission = Permission(type_of(message), Role.GUEST, self._scope)
        limits = limits or Limits()
        self._put(
            CommandEntry(permission, message, work, needs_router, limits, same_for_all=same_for_all)
        )

    def student(
        self,
        message: type[_Command],
        work: Work[_Target, _Command],
        *,
        limits: Limits | None = None,
    ) -> None:
        """Add a command that all may send who take part, and not only look."""
        self._add(message, work, Role.STUDENT, limits=limits)

    def controller(  # noqa: PLR0913 - by name, and few have more than one
        self,
        message: type[_Command],
        work: Work[_Target, _Command],
        *,
        scope: Scope | None = None,
        needs_router: bool = False,
        limits: Limits | None = None,
        on_copies: OnCopies = OnCopies.ALLOWED,
        reviews: bool = False,
    ) -> None:
        """Add a command for the one person who has control."""
        permission = Permission(type_of(message), Role.STUDENT, scope or self._scope, True)  # noqa: FBT003
        limits = limits or Limits()
        self._put(CommandEntry(permission, message, work, needs_router, limits, on_copies, reviews))

    def helper(
        self,
        message: type[_Command],
        work: Work[_Target, _Command],
        *,
        limits: Limits | None = None,
    ) -> None:
        """Add a command for the presenter and those who help."""
        self._add(message, work, Role.HELPER, limits=limits)

    def presenter(
        self,
        message: type[_Command],
        work: Work[_Target, _Command],
        *,
        scope: Scope | None = None,
        needs_router: bool = False,
        limits: Limits | None = None,
    ) -> None:
        """Add a command for the presenter alone, whoever has control."""
        self._add(
            message, work, Role.PRESENTER, scope=scope, needs_router=needs_router, limits=limits
        )

    def _add(
        self,
        message: type[_Command],
        work: Work[_Target, _Command],
        role: Role,
        *,
        scope: Scope | None = None,
        needs_router: bool = False,
        limits: Limits | None = None,
    ) -> None:
        permission = Permission(type_of(message), role, scope or self._scope)
        self._put(CommandEntry(permission, message, work, needs_router, limits or Limits()))

    def include(self, part: Commands[_Part], of: Callable[[_Target, Command], _Part]) -> None:
        """Add the commands of a part; `of` gives the part that a command is for."""
        for entry in part:
            self._put(_within(entry, of))

    async def carry_out(self, target: _Target, command: Command, asker: Listener) -> Answer:
        """Carry out one command.

        Returns:
            What the asker alone is answered, if anything.

        Raises:
            StudioError: It cannot be done.
        """
        answer = self._entries[type(command)].work(target, command, asker)
        return await answer if isawaitable(answer) else answer

    def _put(self, entry: CommandEntry[_Target]) -> None:
        if entry.message in self._entries:
            raise ValueError(f"{entry.permission.name} is registered twice")
        self._entries[entry.message] = entry


def _within(
    entry: CommandEntry[_Part], of: Callable[[_Target, Command], _Part]
) -> CommandEntry[_Target]:
    work = entry.work

    def carry_out(target: _Target, command: Command, asker: Listener) -> Answer | Awaitable[Answer]:
        return work(of(target, command), command, asker)

    return CommandEntry(
        entry.permission,
        entry.message,
        carry_out,
        entry.needs_router,
        entry.limits,
        entry.on_copies,
        entry.reviews,
        entry.same_for_all,
    )


class CommandRates:
    """Holds every person to the rates of the commands."""

    def __init__(self) -> None:
        self._left: dict[tuple[str, str], tuple[float, float]] = {}
        """By person and command: how many more may come at once, and since when (s)."""

    def spend(self, person: str, entry: CommandEntry[Any]) -> None:
        """Count one command.

        Raises:
            CommandError: This person sends it too often.
        """
        if (per_second := entry.limits.per_second) is None:
            return
        now_s = time.monotonic()
        key = person, entry.permission.name
        left, since_s = self._left.get(key, (per_second, now_s))
        left = min(per_second, left + (now_s - since_s) * per_second)
        if left < 1:
            raise CommandError(
                f"{entry.permission.name.replace('_', ' ').capitalize()} is taken at most "
                f"{per_second:.0f} times per second: wait a moment."
            )
        self._left[key] = left - 1, now_s
        if len(self._left) > _RATES_MAX:
            full = [one for one, (_, at_s) in self._left.items() if now_s - at_s > 1]
            for one in full:
                del self._left[one]


REMEMBERED_MAX: Final = 20_000
"""Outcomes, of all persons together; those of who asked nothing for longest are forgotten first."""
REMEMBERED_OF_ONE: Final = 200
"""Outcomes of one person: more than pages of theirs have on the way. However much others ask, what
was asked before a line was cut runs once when it is asked again."""


class AtMostOnce:
    """Remembers how commands with an id ended, by person and id.

    A page sends what was not answered before its connection broke once more. If it ran, or runs
    still, the answer is that of the first time, errors too.
    """

    def __init__(self) -> None:
        self._outcomes: OrderedDict[str, OrderedDict[str, asyncio.Task[Answer]]] = OrderedDict()
        self._count = 0

    async def run(
        self,
        command: Command,
        asker: Listener,
        carry_out: Callable[[Command, Listener], Awaitable[Answer]],
    ) -> Answer:
        """Carry the command out, unless it was carried out or still is.

        Raises:
            StudioError: As `carry_out` raises or raised.
        """
        if not command.id:
            return await carry_out(command, asker)
        known = self._outcomes.get(asker.person)
        running = None if known is None else known.get(command.id)
        if running is None:
            running = asyncio.ensure_future(carry_out(command, asker))
            running.add_done_callback(_noticed)
            self._remember(asker.person, command.id, running)
        # Who asked may leave: what runs is finished all the same.
        answer = await asyncio.shield(running)
        if answer is not None and "request" in type(answer).model_fields:
            return answer.model_copy(update={"request": command.request})
        return answer

    def _remember(self, person: str, name: str, running: asyncio.Task[Answer]) -> None:
        outcomes = self._outcomes.setdefault(person, OrderedDict())
        self._outcomes.move_to_end(person)
        outcomes[name] = running
        self._count += 1
        if len(outcomes) > REMEMBERED_OF_ONE:
            outcomes.popitem(last=False)
            self._count -= 1
        while self._count > REMEMBERED_MAX:
            _, forgotten = self._outcomes.popitem(last=False)
            self._count -= len(forgotten)


def _noticed(outcome: asyncio.Task[Answer]) -> None:
    """Look at a failure, for who asked may have left."""
    if not outcome.cancelled():
        outcome.exception()
