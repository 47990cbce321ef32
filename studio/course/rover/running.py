"""Running the rover: its node, its model, and one executor for both."""

from __future__ import annotations

import argparse
import sys
from contextlib import suppress
from pathlib import Path

import studio.ros.client as rclpy
from studio.course.rover.model import OwnModel, model_file, urdf_of
from studio.course.rover.node import RoverNode
from studio.course.running import until_stopped
from studio.ros.client import SingleThreadedExecutor

_ROS_ARGUMENTS = "--ros-args"
_MAPPING = ":="


def run(args: list[str] | None) -> None:
    """Drive until stopped.

    Args:
        args: A xacro of the rover and what it takes as `name:=value`, both if need be;
            `--router`, as everywhere; after `--ros-args` what ROS takes.
    """
    arguments = sys.argv[1:] if args is None else args
    options, mapping = _read(arguments)
    with until_stopped(arguments, options.router):
        rover = RoverNode()
        executor = SingleThreadedExecutor()
        executor.add_node(rover)
        model = OwnModel(executor, urdf_of(options.file or model_file(), mapping))
        rover.create_timer(1.0, lambda: model.check(rover))
        model.check(rover)
        with suppress(rclpy.ExternalShutdownException):
            executor.spin()


def _read(arguments: list[str]) -> tuple[argparse.Namespace, dict[str, str]]:
    end = arguments.index(_ROS_ARGUMENTS) if _ROS_ARGUMENTS in arguments else len(arguments)
    own = arguments[:end]
    parser = argparse.ArgumentParser(prog="rover")
    parser.add_argument("file", metavar="FILE", type=Path, nargs="?")
    parser.add_argument("--router", default="auto")
    options = parser.parse_args([argument for argument in own if _MAPPING not in argument])
    pairs = (argument.partition(_MAPPING) for argument in own if _MAPPING in argument)
    return options, {name.strip(): value.strip() for name, _, value in pairs}
