"""The registry: what it refuses, how parts become a whole, and how often a person may ask."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field

import pytest

from studio.documents.engine import COMMANDS
from studio.errors import CommandError
from studio.protocol.commands import CommandRates, Commands, Limits, Scope, may
from studio.protocol.documents import Gone
from studio.protocol.edits import Redo, Undo
from studio.protocol.message import Command, Event, all_events
from studio.protocol.roles import Role, Visitor
from tests.support.open_documents import Ear


@dataclass
class Part:
    done: list[Command] = field(default_factory=list[Command])

    def undo(self, command: Undo) -> Gone:
        self.done.append(command)
        return Gone(document=command.document)

    async def redo(self, command: Redo) -> None:
        await asyncio.sleep(0)
        self.done.append(command)


PART = Commands[Part](Scope.DOCUMENT)
PART.viewer(Undo, lambda part, c, _: part.undo(c))
PART.presenter(Redo, lambda part, c, _: part.redo(c), scope=Scope.ROS, limits=Limits(per_second=2))


def test_a_whole_carries_out_the_commands_of_its_parts():
    whole: Commands[dict[str, Part]] = Commands(Scope.STUDIO)
    whole.include(PART, lambda parts, c: parts[c.document])
    parts = {"a": Part(), "b": Part()}
    answer = asyncio.run(whole.carry_out(parts, Undo(document="a"), Ear()))
    assert isinstance(answer, Gone)
    assert asyncio.run(whole.carry_out(parts, Redo(document="b"), Ear())) is None
    assert (parts["a"].done, parts["b"].done) == ([Undo(document="a")], [Redo(document="b")])


def test_a_command_keeps_its_role_and_scope_in_the_whole():
    whole: Commands[Part] = Commands(Scope.STUDIO)
    whole.include(PART, lambda part, _: part)
    permissions = {one.name: (one.role, one.scope) for one in (each.permission for each in whole)}
    assert permissions == {
        "undo": (Role.GUEST, Scope.DOCUMENT),
        "redo": (Role.PRESENTER, Scope.ROS),
    }


def test_a_viewer_is_allowed_what_all_may_and_nobody_is_allowed_nothing():
    undo, redo = (PART[kind].permission for kind in (Undo, Redo))
    assert may(Visitor(Role.GUEST), undo)
    assert may(Visitor(Role.PRESENTER), undo)
    assert may(Visitor(Role.PRESENTER), redo)
    assert not may(Visitor(Role.GUEST), redo)
    assert not may(None, undo)


def test_a_command_is_registered_once():
    with pytest.raises(ValueError, match="undo is registered twice"):
        PART.viewer(Undo, lambda part, c, _: part.undo(c))


def test_every_command_that_is_defined_is_registered_and_none_is_an_event():
    def below(kind: type[Command]) -> set[type[Command]]:
        own = {kind} if "type" in kind.model_fields else set[type[Command]]()
        return own.union(*(below(one) for one in kind.__subclasses__()))

    assert below(Command) == set(COMMANDS.messages)
    assert all(issubclass(kind, Event) for kind in all_events())


def test_a_rate_holds_for_each_person_and_says_what_it_is():
    rates = CommandRates()
    somebody, another = Visitor(Role.PRESENTER, "a"), Visitor(Role.PRESENTER, "b")
    for _ in range(2):
        rates.spend(somebody.person, PART[Redo])
    with pytest.raises(CommandError, match="Redo is taken at most 2 times per second"):
        rates.spend(somebody.person, PART[Redo])
    rates.spend(another.person, PART[Redo])
    for _ in range(100):
        rates.spend(somebody.person, PART[Undo])
