"""LifecycleClient: reads and changes the state of another node, a managed one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from studio.ros.node.spinning import ANSWER_TIMEOUT_S, call_service

if TYPE_CHECKING:
    from typing import Self

    from studio.ros.node.node import Node
    from studio.ros.types.classes import MessageValue

_SERVICES = {
    "change_state": "ChangeState",
    "get_state": "GetState",
    "get_available_states": "GetAvailableStates",
    "get_available_transitions": "GetAvailableTransitions",
    "get_transition_graph": "GetAvailableTransitions",
}


class LifecycleClient:
    """Every question waits at most `timeout_s`; `with` takes the clients back at the end.

    Questions raise NotServedError when the node is no managed one, and NoAnswerError when it
    does not answer.
    """

    def __init__(self, node: Node, remote: str, timeout_s: float = ANSWER_TIMEOUT_S) -> None:
        self._node = node
        self._timeout_s = timeout_s
        self.remote = node.resolve_service_name(remote)
        types = node.context.wire.types
        self._transition_type = types.message("lifecycle_msgs/msg/Transition")
        self._clients = {
            name: node.create_client(
                types.service(f"lifecycle_msgs/srv/{kind}"), f"{self.remote}/{name}"
            )
            for name, kind in _SERVICES.items()
        }

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Take the clients back."""
        for client in self._clients.values():
            self._node.destroy_client(client)

    def state(self) -> Any:  # noqa: ANN401  # a lifecycle_msgs/msg/State
        """Return the state that the node is in."""
        return self._ask("get_state").current_state

    def change(self, transition: int | str) -> bool:
        """Trigger a transition by its number or label; return whether it succeeded."""
        wanted = self._transition_type()
        if isinstance(transition, int):
            wanted.id = transition
        else:
            wanted.label = transition
        return bool(self._ask("change_state", transition=wanted).success)

    def available_states(self) -> list[MessageValue]:
        """Return every state that the node has."""
        return list(self._ask("get_available_states").available_states)

    def available_transitions(self) -> list[MessageValue]:
        """Return the TransitionDescriptions of what the node can do now."""
        return list(self._ask("get_available_transitions").available_transitions)

    def transition_graph(self) -> list[MessageValue]:
        """Return the TransitionDescriptions of all that the node can ever do."""
        return list(self._ask("get_transition_graph").available_transitions)

    def _ask(self, service: str, **fields: Any) -> Any:  # noqa: ANN401  # a response
        client = self._clients[service]
        return call_service(self._node, client, client.srv_type.Request(**fields), self._timeout_s)
