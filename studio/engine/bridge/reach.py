"""What asks or tells other nodes, and so is refused at once while the router is away."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.engine.messages import calls, goals, lifecycle, parameters, publishing
from studio.engine.messages.driving import Drive
from studio.errors import RouterGoneError

if TYPE_CHECKING:
    from studio.engine.messages.message import CommandMessage
    from studio.engine.wire.link import WireLink

NEEDS_ROUTER: Final[frozenset[type[CommandMessage]]] = frozenset(
    {
        calls.CallService,
        goals.SendGoal,
        goals.CancelGoal,
        lifecycle.ChangeState,
        parameters.GetParameters,
        parameters.SetParameter,
        parameters.DumpParameters,
        parameters.LoadParameters,
        publishing.Publish,
        Drive,
    }
)


def check_reach(command: CommandMessage, link: WireLink | None) -> None:
    """Look whether anybody can be reached; without a connection one is made first.

    Raises:
        RouterGoneError: The command needs the router, which is away.
    """
    if type(command) in NEEDS_ROUTER and link is not None and not link.is_connected:
        raise RouterGoneError(link.endpoint)
