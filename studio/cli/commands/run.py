"""`studio run`: start a node by its package and name, or a Python file."""

from __future__ import annotations

import argparse
import importlib
import os
import shlex
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.interface_types import environment_with
from studio.cli.joining import domain_number
from studio.cli.packages import opened_packages
from studio.cli.terminal import harmless
from studio.cli.wire import STARTING, ended_by_signals
from studio.errors import SettingsError
from studio.importable.hints import HINTS_VARIABLE
from studio.programs.finding import file_program, find_program
from studio.programs.program import RUNNER

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from studio.programs.program import Program
    from studio.ros.node.arguments import RosArguments, Rule

_ROS_ARGUMENTS = "--ros-args"
_PYTHON_FILE = ".py"
_LAUNCH_FILES = (".launch.py", ".launch.xml", ".launch.yaml", ".launch.yml")


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `run` to the parser."""
    parser.usage = (
        "studio run [-h] [--demo] [--strict] [--no-hints] PACKAGE EXECUTABLE [ARGUMENT ...]\n"
        "       studio run [-h] [--strict] [--no-hints] FILE.py [ARGUMENT ...]"
    )
    parser.description = (
        "Start a node of a package, or a Python file. Your own nodes run as they are, with no ROS "
        "installed and nothing built: rclpy, tf2_ros and the messages of your workspace are there "
        "to import (experimental: README, Your own code). Other names start the studio's own nodes "
        "(studio pkg executables lists them), and what is installed on this machine runs as it is. "
        "Where no router answers, the node brings one."
    )
    parser.add_argument(
        "--demo",
        action="store_true",
        help="before PACKAGE: start the studio's own node, though the workspace has that package",
    )
    parser.add_argument(
        "--strict",
        action="store_true",
        help="before PACKAGE: what would fail in ROS 2 is an error here, too, and no warning",
    )
    parser.add_argument(
        "--no-hints",
        action="store_true",
        help=f"before PACKAGE: no hints for beginners; {HINTS_VARIABLE}=0 does the same",
    )
    parser.add_argument("package_name", metavar="PACKAGE")
    parser.add_argument(
        "arguments",
        metavar="EXECUTABLE [ARGUMENT ...]",
        nargs=argparse.REMAINDER,
        help="the node's own arguments; --ros-args -r from:=to -p name:=value as in ROS; "
        "--connect, --domain, --router, --interfaces and --package-path as everywhere",
    )
    parser.set_defaults(run=_run, data_dir=None)


def _run(options: argparse.Namespace) -> int:
    words = [argument.removeprefix(" ") for argument in options.arguments]
    name: str = options.package_name
    _refuse_launch_file(name, words)
    if name.endswith(_PYTHON_FILE) and not options.demo:
        wire, rest = _part_arguments(words)
        options.package_path = wire.package_path
        packages = opened_packages(options, to_run=True)
        return _start(file_program(Path(name), packages), options, wire, rest)
    if not words or words[0].startswith("-"):
        raise SettingsError(
            f"studio run {harmless(name)}: name an executable of the package, too "
            f"(studio pkg executables {harmless(name)} lists them)."
        )
    wire, rest = _part_arguments(words[1:])
    options.package_path = wire.package_path
    packages = opened_packages(options, to_run=True)
    program = find_program(packages, name, words[0], demo=options.demo)
    return _start(program, options, wire, rest)


def _refuse_launch_file(name: str, words: Sequence[str]) -> None:
    """Name the command for launch files where one is given in place of a program."""
    line = [name] if name.endswith(_LAUNCH_FILES) else [name, *words[:1]]
    if line[-1].endswith(_LAUNCH_FILES):
        meant = harmless(shlex.join(line))
        raise SettingsError(f"{harmless(line[-1])}: this is a launch file: studio launch {meant}")


def _start(
    program: Program,
    options: argparse.Namespace,
    wire: argparse.Namespace,
    arguments: list[str],
) -> int:
    """Run a program in this process, or as this process."""
    from studio.ros.wire.session import open_wire
    from studio.ros.wire.settings import environment_for, wire_settings

    if program.kind == "command":
        return _run_command(program.arguments[0], program.executable, arguments)
    settings = wire_settings(tuple(wire.connect), wire.domain)
    os.environ.update(program.environment)
    added = environment_for(settings, environment_with(wire.interfaces))
    if program.module == RUNNER:
        from studio.importable.running import run_words
        from studio.ros.node.spinning import ROUTER_VARIABLE

        os.environ.update(added | {ROUTER_VARIABLE: wire.router})
        if options.no_hints:
            os.environ[HINTS_VARIABLE] = "0"
        return run_words(program.arguments, arguments, strict=options.strict)
    if not program.module:
        os.environ.update(added)
        os.execv(program.command[0], [*program.command, *arguments])
    # Held for as long as the node runs: with it goes the router, where one was started here.
    with ended_by_signals(), open_wire(settings, wire.router) as held:
        os.environ.update(environment_for(held.settings, environment_with(wire.interfaces)))
        importlib.import_module(program.module).main(arguments)
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
