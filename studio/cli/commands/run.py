"""`studio run`: start a node by its package and name."""

from __future__ import annotations

import argparse
import importlib
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.interface_types import environment_with
from studio.cli.joining import domain_number
from studio.cli.packages import (
    demo_executables,
    executables_of_all,
    opened_packages,
    workspace_folder,
)
from studio.cli.terminal import harmless
from studio.cli.wire import STARTING, ended_by_signals
from studio.errors import SettingsError
from studio.packages.executables import executables_of, file_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.ros.node.arguments import RosArguments, Rule

_ROS_ARGUMENTS = "--ros-args"
_COMMANDS = {("rviz2", "rviz2"): "open", ("xacro", "xacro"): "xacro"}
"""Programs of ROS that are commands of the studio."""


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `run` to the parser."""
    parser.description = (
        "Start a node: one of the studio's own under the name that the course gives it "
        "(studio pkg executables lists them). Where no router answers, the node brings one. "
        "A package of your workspace comes before ours of the same name: what it would start is "
        "said, for nodes of a workspace are not started yet."
    )
    parser.add_argument(
        "--demo",
        action="store_true",
        help="before PACKAGE: start the studio's own node, though the workspace has that package",
    )
    parser.add_argument("package_name", metavar="PACKAGE")
    parser.add_argument("executable_name", metavar="EXECUTABLE")
    parser.add_argument(
        "arguments",
        metavar="ARGUMENT",
        nargs=argparse.REMAINDER,
        help="the node's own; --ros-args -r from:=to -p name:=value as in ROS; "
        "--connect, --domain, --router, --interfaces and --package-path as everywhere",
    )
    parser.set_defaults(run=_run, data_dir=None)


def _run(options: argparse.Namespace) -> int:
    from studio.course.processes import environment_for
    from studio.ros.wire.session import open_wire
    from studio.ros.wire.settings import wire_settings

    arguments = [argument.removeprefix(" ") for argument in options.arguments]
    command = _COMMANDS.get((options.package_name, options.executable_name))
    if command is not None:
        return _run_command(command, options.executable_name, arguments)
    wire, arguments = _part_arguments(arguments)
    module = _demo_module(options) if options.demo else _module_of(options, wire.package_path)
    settings = wire_settings(tuple(wire.connect), wire.domain)
    # Held for as long as the node runs: with it goes the router, where one was started here.
    with ended_by_signals(), open_wire(settings, wire.router) as held:
        os.environ.update(environment_for(held.settings, environment_with(wire.interfaces)))
        importlib.import_module(module).main(arguments)
    return 0


def _run_command(command: str, program: str, arguments: Sequence[str]) -> int:
    """Run a command in place of a program of ROS; print on stderr what it does not use.

    Raises:
        RosArgumentError: What follows `--ros-args` cannot be read.
    """
    from studio.cli.main import main
    from studio.ros.node.arguments import parse_arguments

    read = parse_arguments(arguments)
    if unused := tuple(_unused(read)):
        listed = harmless(", ".join(unused))
        instead = f"studio {command}, which runs in place of {program}"
        print(f"WARNING: {instead}, does not use {listed}.", file=sys.stderr)
    return main([command, *read.rest])


def _unused(read: RosArguments) -> Iterator[str]:
    """Yield the arguments of ROS without a counterpart: the studio's node has names of its own."""
    yield from (f"-r {one}" for one in read.remaps)
    yield from (f"-p {one}" for one in read.parameters if not _is_sim_time(one))
    yield from (f"--params-file {one}" for one in read.files)
    for logger, level in read.levels:
        yield f"--log-level {logger}{':=' if logger else ''}{level.name.lower()}"


def _is_sim_time(rule: Rule) -> bool:
    """Whether it asks for the time of /clock, which the studio takes where it is published."""
    return rule.source == "use_sim_time" and rule.target.lower() == "true"


def _part_arguments(arguments: Sequence[str]) -> tuple[argparse.Namespace, list[str]]:
    """Take what is of the wire out of a node's arguments, as far as `--ros-args`."""
    end = arguments.index(_ROS_ARGUMENTS) if _ROS_ARGUMENTS in arguments else len(arguments)
    parser = argparse.ArgumentParser(prog="studio run", add_help=False, allow_abbrev=False)
    parser.add_argument("--connect", action="append", default=[])
    parser.add_argument("--domain", type=domain_number)
    parser.add_argument("--router", default=STARTING)
    parser.add_argument("--interfaces", action="append", default=[], type=Path)
    parser.add_argument("--package-path", action="append", default=[])
    wire, rest = parser.parse_known_args(arguments[:end])
    return wire, [*rest, *arguments[end:]]


def _demo_module(options: argparse.Namespace) -> str:
    """Find the studio's own node, whatever the workspace has.

    Raises:
        SettingsError: It has none of that name.
    """
    package, name = options.package_name, options.executable_name
    module = demo_executables().get(package, {}).get(name)
    if module is None:
        raise SettingsError(f"The studio has no node {package} {name}: studio demos lists them.")
    return module


def _module_of(options: argparse.Namespace, package_path: list[str]) -> str:
    """Find what is started.

    Raises:
        SettingsError: The studio has no such node, or the workspace has a package of that name;
            the sentence names what there is instead.
    """
    package, name = options.package_name, options.executable_name
    own = demo_executables().get(package, {})
    options.package_path = package_path
    index = opened_packages(options)
    folder = workspace_folder(index, package)
    if folder is not None:
        raise SettingsError(_workspace_sentence(folder, package, name, is_ours=name in own))
    if name in own:
        return own[name]
    known = executables_of_all(index).get(package, {})
    if name in known:
        raise SettingsError(
            f"{package} {name} is a program of ROS ({known[name]}): the studio starts only nodes "
            "of its own, run it with ros2 run where ROS is installed."
        )
    if known:
        raise SettingsError(
            f'{package} has no executable "{name}": it has {", ".join(sorted(known))}.'
        )
    if package in index:
        raise SettingsError(f"{package} ({index.best(package, Path.cwd())}) starts nothing.")
    raise SettingsError(
        f'No package "{package}" is known: studio pkg executables lists what can be started.'
    )


def _workspace_sentence(folder: Path, package: str, name: str, *, is_ours: bool) -> str:
    """Return what the workspace has under a name, and how to start the studio's own."""
    known = executables_of(folder, package)
    if name in known:
        text = (
            f"Your workspace has {package} {name}: the package is {folder}, and it would start "
            f"{_program(folder, known[name])}. The studio does not start nodes of a workspace "
            f"yet, so nothing runs: where ROS is installed, ros2 run {package} {name} starts it."
        )
    elif known:
        text = (
            f'Your workspace has the package {package} ({folder}), which has no executable "{name}"'
            f": it has {', '.join(sorted(known))}."
        )
    else:
        text = (
            f"Your workspace has the package {package} ({folder}), which starts nothing: no "
            'entry in console_scripts of its setup.py, no install to "lib/${PROJECT_NAME}" in its '
            "CMakeLists.txt."
        )
    demo = f" The studio's demo of that name starts with: studio run --demo {package} {name}"
    return text + (demo if is_ours else "")


def _program(folder: Path, place: str) -> str:
    """Return what an executable is: its file, and the function in it."""
    path = file_of(folder, place)
    module, colon, function = place.partition(":")
    if not colon:
        return str(path) if path else f"{folder / place}, which is not there"
    if path is None:
        return f"{place}, but no file of the package is the module {module}"
    return f"{function}() in {path}"
