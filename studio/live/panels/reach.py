"""What asks or tells other nodes, and so is refused at once while the router is away."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import RouterGoneError
from studio.protocol import calls, goals, lifecycle, parameters, publishing
from studio.protocol.driving import Drive

if TYPE_CHECKING:
    from studio.live.connection.link import WireLink
    from studio.protocol.message import CommandMessage

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
