"""A plan as text for a terminal."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.launch.plan import (
        Plan,
        PlannedArgument,
        PlannedCondition,
        PlannedNode,
        PlannedProcess,
        PlannedStart,
    )


def shown_arguments(plan: Plan) -> str:
    """Return the arguments as `ros2 launch --show-args` prints them."""
    lines = ["Arguments (pass arguments as '<name>:=<value>'):"]
    seen: set[str] = set()
    for one in plan.arguments:
        if one.name not in seen:
            seen.add(one.name)
            lines += ["", *_argument(one)]
    if not seen:
        lines += ["", "  No arguments."]
    return "\n".join(lines)


def _argument(one: PlannedArgument) -> Iterator[str]:
    yield f"    '{one.name}':"
    text = " ".join(one.description.split()) or "no description given"
    if one.choices:
        listed = ", ".join(repr(choice) for choice in one.choices)
        text = f"{text.rstrip('.')}. Valid choices are: [{listed}]"
    yield f"        {text}"
    if one.default is not None:
        yield f"        (default: '{one.default}')"
    elif one.include is None or one.value is None:
        yield "        (no default: a value is needed)"


def shown_plan(plan: Plan) -> str:
    """Return a whole plan, a part below the other; empty parts are left out."""
    parts = [
        ("Arguments", list(_arguments(plan))),
        ("Includes", [_include(plan, number) for number in range(len(plan.includes))]),
        ("Environment", [_setting(one.name, one.value) for one in plan.settings]),
        ("Nodes", [line for one in plan.nodes for line in _node(plan, one)]),
        ("Commands", [line for one in plan.processes for line in _process(one)]),
        ("Later", [line for one in plan.happenings for line in _happening(one.when, one.does)]),
        ("Robots", [_robot(one.file, one.mappings) for one in plan.robots]),
        ("Log", [one.text for one in plan.log]),
        ("Not supported", [f"{one.where}: {one.sentence}" for one in plan.unsupported]),
        ("Wrong", [f"{one.where}: {one.sentence}" for one in plan.failures]),
    ]
    blocks = [
        f"{title}:\n" + "\n".join(f"  {line}" for line in lines) for title, lines in parts if lines
    ]
    return "\n".join([f"{plan.file}", *blocks])


def _arguments(plan: Plan) -> Iterator[str]:
    for one in plan.arguments:
        if one.include is None or one.value is None:
            value = "has no value" if one.value is None else f":= {one.value}"
            choices = f"  (one of {', '.join(one.choices)})" if one.choices else ""
            yield f"{one.name} {value}{choices}"


def _include(plan: Plan, number: int) -> str:
    one = plan.includes[number]
    depth = 0
    parent = one.parent
    while parent is not None:
        depth, parent = depth + 1, plan.includes[parent].parent
    given = "".join(f" {name}:={shlex.quote(value)}" for name, value in one.arguments.items())
    failed = "  (not read)" if one.failed else ""  # why is among what is wrong
    return f"{'  ' * depth}{one.file}{given}{_state(one.condition, one.when)}{failed}"


def _setting(name: str, value: str | None) -> str:
    return f"{name} is unset" if value is None else f"{name}={value}"


def _node(plan: Plan, one: PlannedNode) -> Iterator[str]:
    name = one.full_name or one.namespace.rstrip("/") + "/?"
    yield f"{name}  {one.package} {one.executable}{_state(one.condition, one.when)}"
    yield f"    {_start(one.start)}"
    for parameter in one.parameters:
        value = parameter.value
        if parameter.robot is not None:
            value = _robot(plan.robots[parameter.robot].file, plan.robots[parameter.robot].mappings)
        of_file = f"  ({parameter.file})" if parameter.file else ""
        yield f"    {parameter.name}: {value}{of_file}"
    for remap in one.remaps:
        yield f"    {remap.source} -> {remap.target}"
    for title, words in (
        ("arguments", one.arguments),
        ("ROS arguments", one.ros_arguments),
        ("prefix", one.prefix),
    ):
        if words:
            yield f"    {title}: {shlex.join(words)}"
    yield from _surroundings(one.cwd, one.environment)
    if one.respawn:
        yield f"    is started again {one.respawn_delay_s:g} s after its end"
    if one.container:
        yield f"    in the container {one.container}"


def _process(one: PlannedProcess) -> Iterator[str]:
    yield f"{' '.join(one.command)}{_state(one.condition, one.when)}"
    yield f"    {_start(one.start)}"
    yield from _surroundings(one.cwd, one.environment)


def _surroundings(cwd: str, environment: dict[str, str]) -> Iterator[str]:
    if cwd:
        yield f"    in the folder {cwd}"
    yield from (f"    with {_setting(name, value)}" for name, value in environment.items())


def _start(start: PlannedStart) -> str:
    words = {
        "node": "starts",
        "studio": "starts the studio's own:",
        "page": "",
        "installed": "starts",
        "command": "runs",
        "none": "not started:",
    }
    return f"{words.get(start.kind, start.kind)} {start.text}".strip()


def _happening(when: str, does: tuple[str, ...]) -> Iterator[str]:
    yield f"{when}:"
    yield from (f"    {one}" for one in does)


def _robot(file: str, mappings: dict[str, str]) -> str:
    given = "".join(f" {name}:={shlex.quote(value)}" for name, value in mappings.items())
    return f"{file or 'a robot whose file is not known'}{given}"


def _state(condition: PlannedCondition | None, when: str) -> str:
    later = f"  [{when}]" if when else ""
    if condition is None:
        return later
    holds = {True: "holds", False: "does not hold", None: "depends on a missing argument"}
    return f"{later}  [{condition.text}: {holds[condition.holds]}]"
