"""The services by which others steer a player, named and typed as those of `/rosbag2_player`."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final, TypeAlias

from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.nodes.bag_player.player import BagPlayer
    from studio.ros.client import Node
    from studio.ros.types.classes import MessageValue

NODE_NAME: Final = "rosbag2_player"
_Answer: TypeAlias = "Callable[[BagPlayer, MessageValue, MessageValue], object]"


def serve_player(node: Node, player: BagPlayer) -> None:
    """Serve `~/pause` and the others by a node."""
    for name, (type_name, answer) in _SERVICES.items():
        kind = node.wire.types.service(f"rosbag2_interfaces/srv/{type_name}")
        node.create_service(kind, f"~/{name}", partial(_answered, player, answer))


def _answered(
    player: BagPlayer, answer: _Answer, request: MessageValue, response: MessageValue
) -> MessageValue:
    answer(player, request, response)
    return response


def _pause(player: BagPlayer, *_: MessageValue) -> None:
    player.pause()


def _resume(player: BagPlayer, *_: MessageValue) -> None:
    player.resume()


def _toggle_paused(player: BagPlayer, *_: MessageValue) -> None:
    player.toggle_paused()


def _is_paused(player: BagPlayer, _request: MessageValue, response: MessageValue) -> None:
    response.paused = player.is_paused


def _get_rate(player: BagPlayer, _request: MessageValue, response: MessageValue) -> None:
    response.rate = player.rate


def _set_rate(player: BagPlayer, request: MessageValue, response: MessageValue) -> None:
    response.success = player.set_rate(request.rate)


def _play(player: BagPlayer, request: MessageValue, response: MessageValue) -> None:
    """Begin anew; an empty request plays to the end, where rosbag2's plays nothing."""
    duration_ns = _ns(request.playback_duration)
    until_ns = _ns(request.playback_until_timestamp)
    response.success = player.play(
        max(0, _ns(request.start_offset)),
        duration_ns if duration_ns > 0 else None,
        until_ns if until_ns > 0 else None,
    )


def _play_next(player: BagPlayer, _request: MessageValue, response: MessageValue) -> None:
    response.success = player.play_next()


def _burst(player: BagPlayer, request: MessageValue, response: MessageValue) -> None:
    response.actually_burst = player.burst(request.num_messages)


def _seek(player: BagPlayer, request: MessageValue, response: MessageValue) -> None:
    response.success = player.seek(_ns(request.time))


def _stop(player: BagPlayer, *_: MessageValue) -> None:
    player.stop()


def _ns(span: MessageValue) -> int:
    """Return a Time or a Duration in ns."""
    return span.sec * NANOSECONDS + span.nanosec


_SERVICES: Final[dict[str, tuple[str, _Answer]]] = {
    "pause": ("Pause", _pause),
    "resume": ("Resume", _resume),
    "toggle_paused": ("TogglePaused", _toggle_paused),
    "is_paused": ("IsPaused", _is_paused),
    "get_rate": ("GetRate", _get_rate),
    "set_rate": ("SetRate", _set_rate),
    "play": ("Play", _play),
    "play_next": ("PlayNext", _play_next),
    "burst": ("Burst", _burst),
    "seek": ("Seek", _seek),
    "stop": ("Stop", _stop),
}
