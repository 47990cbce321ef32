"""Runs a launch file, or one node as if a launch file named it, in this process."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.errors import LaunchError, StudioError
from studio.launch.modules import install
from studio.launch.runner import Runner
from studio.launch.vocabulary.context import LaunchContext, use_host
from studio.launch.vocabulary.sources import AnyLaunchDescriptionSource, LaunchDescriptionSource
from studio.launch.watchdog import take_up_orphans
from studio.packages.passing import environment_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.launch.prepared import Prepared
    from studio.launch.reporting import Reporter
    from studio.packages.index import PackageIndex


def run_launch_file(
    file: Path,
    given: Mapping[str, str],
    index: PackageIndex,
    environment: Mapping[str, str],
    reporter: Reporter,
    commands: int | None = None,
    prepared: Prepared | None = None,
) -> int:
    """Run a launch file until all that it started has ended; returns the exit code.

    Args:
        file: The launch file.
        given: Values of its arguments.
        index: The packages.
        environment: What nodes need to join the router.
        reporter: Who is told.
        commands: A descriptor on which commands come; its end ends the group.
        prepared: Makes nodes in Python, where it can.
    """
    return _run(
        AnyLaunchDescriptionSource(str(file)),
        file,
        given,
        index,
        environment,
        reporter,
        commands,
        prepared,
    )


def run_node(
    words: list[str],
    index: PackageIndex,
    environment: Mapping[str, str],
    reporter: Reporter,
    commands: int | None = None,
    prepared: Prepared | None = None,
) -> int:
    """Run PACKAGE EXECUTABLE with further words as its arguments.

    Raises:
        LaunchError: One of both is missing.
    """
    from studio.launch.vocabulary.actions import LaunchDescription  # noqa: PLC0415
    from studio.launch.vocabulary.ros import Node  # noqa: PLC0415

    if len(words) < 2:
        raise LaunchError("A node is started by its package and executable: name both.")
    package, executable, *arguments = words
    node = Node(package=package, executable=executable, arguments=arguments, output="screen")
    source = LaunchDescriptionSource(launch_description=LaunchDescription([node]))
    return _run(source, Path.cwd(), {}, index, environment, reporter, commands, prepared)


def _run(
    source: LaunchDescriptionSource,
    asking: Path,
    given: Mapping[str, str],
    index: PackageIndex,
    environment: Mapping[str, str],
    reporter: Reporter,
    commands: int | None,
    prepared: Prepared | None,
) -> int:
    take_up_orphans()
    os.environ.update(environment_of(index, asking))
    runner = Runner(index, asking, environment, reporter, prepared=prepared)
    use_host(runner)
    install(index, asking, stand_in=False)
    runner.guard(commands)
    try:
        runner.load(
            source, given, LaunchContext(runner, argv=[f"{k}:={v}" for k, v in given.items()])
        )
    except StudioError as error:
        reporter.log("error", str(error))
        reporter.ended(1)
        return 1
    return runner.run()
