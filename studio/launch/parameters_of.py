"""The parameters that a node of a plan is given, those of files included."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, cast

import numpy as np

from studio.errors import StudioError
from studio.launch.plan import PlannedParameter, Value
from studio.launch.vocabulary.parameters import read_text
from studio.launch.vocabulary.temporary import source_of
from studio.launch.vocabulary.texts import is_unknown

if TYPE_CHECKING:
    from studio.launch.robots import Robots
    from studio.launch.vocabulary.requests import Request

_TEXT_MAX: Final = 2_000
_VALUES_MAX: Final = 2_000
_ITEMS_MAX: Final = 500


@dataclass(slots=True)
class Found:
    """Parameters, their files, and what cannot be read of them."""

    parameters: tuple[PlannedParameter, ...] = ()
    files: tuple[str, ...] = ()
    failures: list[str] = field(default_factory=list[str])


def planned_parameters(request: Request, robots: Robots, node: int) -> Found:
    """Return what a node is given; a later one of a name counts, as in ROS."""
    found: dict[str, PlannedParameter] = {}
    result = Found()
    files: list[str] = []
    full_name = request.full_name or f"{request.namespace.rstrip('/')}/{request.executable}"
    for name, value in request.global_parameters:
        if name:
            found[name] = PlannedParameter(name, shown_value(value))
        else:
            files.append(source_of(str(value)))
            _read(str(value), full_name, found, result)
    for one in request.parameters:
        if one.values is None:
            files.append(source_of(one.path))
            _read(one.path, full_name, found, result)
            continue
        for name, value in one.values.items():
            found[name] = _parameter(name, value, request, robots, node)
    result.parameters = tuple(found.values())[:_VALUES_MAX]
    result.files = tuple(files)
    return result


def _parameter(
    name: str, value: Any, request: Request, robots: Robots, node: int
) -> PlannedParameter:
    if isinstance(value, str) and "<" in value:
        robot = robots.robot_of(value, request.where, node)
        if robot is not None:
            return PlannedParameter(name, robot=robot)
    return PlannedParameter(name, shown_value(value))


def _read(path: str, full_name: str, into: dict[str, PlannedParameter], result: Found) -> None:
    if is_unknown(path):
        return
    from studio.ros.parameters.files import read_parameters  # noqa: PLC0415

    shown = source_of(path)
    try:
        for one in read_parameters(read_text(path), full_name, shown):
            into[one.name] = PlannedParameter(one.name, shown_value(one.value), shown)
    except StudioError as error:
        result.failures.append(str(error))


def shown_value(value: Any) -> Value:
    """Return a parameter's value as JSON has it, long ones cut."""
    if isinstance(value, str):
        return value if len(value) <= _TEXT_MAX else f"{value[:_TEXT_MAX]}..."
    if value is None or isinstance(value, bool | int | float):
        return value
    if isinstance(value, bytes):
        return value.hex()[:_TEXT_MAX]
    if isinstance(value, np.ndarray):
        return cast("Value", value.tolist()[:_ITEMS_MAX])  # pyright: ignore
    if isinstance(value, list | tuple) or hasattr(value, "tolist"):
        items = cast("list[Any]", list(value))[:_ITEMS_MAX]
        return [one if isinstance(one, bool | int | float | str) else str(one) for one in items]
    return str(value)[:_TEXT_MAX]
