"""ParameterCallbacks: whom a node asks before a change of parameters, and tells after it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.types.classes import MessageValue

PreSetCallback = Callable[[list["Parameter"]], list["Parameter"]]
OnSetCallback = Callable[[list["Parameter"]], Any]
"""It gives a SetParametersResult; anything with `successful` and `reason` is taken."""
PostSetCallback = Callable[[list["Parameter"]], None]


class ParameterCallbacks:
    """The callbacks of a node; those added last are asked first, as in rclpy."""

    def __init__(self) -> None:
        self.pre_set: list[PreSetCallback] = []
        self.on_set: list[OnSetCallback] = []
        self.post_set: list[PostSetCallback] = []

    def before(self, parameters: list[Parameter]) -> list[Parameter]:
        """Let callbacks change what is to be set."""
        for callback in self.pre_set:
            parameters = list(callback(parameters))
        return parameters

    def ask(self, parameters: list[Parameter], agreed: MessageValue) -> Any:  # noqa: ANN401
        """Give the first refusal; `agreed` is the result that means that there was none."""
        for callback in self.on_set:
            result = callback(parameters)
            if not getattr(result, "successful", False):
                return _refusal(result, agreed)
        return agreed

    def after(self, parameters: Iterable[Parameter]) -> None:
        """Tell that parameters were set."""
        for callback in self.post_set:
            callback(list(parameters))


def _refusal(result: Any, agreed: MessageValue) -> MessageValue:  # noqa: ANN401
    # A callback without a return statement refuses everything: say so, it is a usual slip.
    reason = getattr(result, "reason", "the callback of the node returned no SetParametersResult")
    return type(agreed)(successful=False, reason=reason or "the callback of the node refused it")
