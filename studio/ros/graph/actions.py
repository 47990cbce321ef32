"""Actions in the graph: known by the three services that every server of one has."""

from __future__ import annotations

_GOAL = "/_action/send_goal"
_GOAL_TYPE = "_SendGoal"


def goal_service(action: str) -> str:
    """Name the service that takes an action's goals."""
    return action + _GOAL


def names_and_types(services: list[tuple[str, list[str]]]) -> list[tuple[str, list[str]]]:
    """Find the actions among services; one whose type is no action's is a service only."""
    found = (
        (name.removesuffix(_GOAL), [one.removesuffix(_GOAL_TYPE) for one in _goal_types(types)])
        for name, types in services
        if name.endswith(_GOAL) and len(name) > len(_GOAL)
    )
    return [(name, types) for name, types in found if types]


def _goal_types(types: list[str]) -> list[str]:
    return [one for one in types if "/action/" in one and one.endswith(_GOAL_TYPE)]
