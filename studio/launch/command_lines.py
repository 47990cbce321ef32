"""The command line of a node, as launch_ros writes it: names, files of parameters, remaps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import yaml

from studio.launch.vocabulary.temporary import written

if TYPE_CHECKING:
    from studio.launch.vocabulary.requests import Request


def command_line(request: Request, command: tuple[str, ...]) -> list[str]:
    """Return the words that start a request; files of parameters are written for it."""
    if request.kind == "process":
        return [*request.prefix, *command]
    ros = ros_words(request)
    behind = ["--ros-args", *ros] if ros else []
    return [*request.prefix, *command, *request.arguments, *behind]


def ros_words(request: Request) -> list[str]:
    """Return what stands behind `--ros-args`."""
    words = list(request.ros_arguments)
    if request.name:
        words += ["-r", f"__node:={request.name}"]
    if request.namespace not in ("", "/"):
        words += ["-r", f"__ns:={request.namespace}"]
    for name, value in request.global_parameters:
        path = _file_of(request, {name: value}) if name else str(value)
        words += ["--params-file", path]
    for one in request.parameters:
        path = one.path if one.values is None else _file_of(request, one.values)
        if path:
            words += ["--params-file", path]
    for source, target in request.remaps:
        words += ["-r", f"{source}:={target}"]
    return words


def _file_of(request: Request, values: dict[str, Any]) -> str:
    if not values:
        return ""
    node = request.full_name or "/**"
    tree = {node: {"ros__parameters": values}}
    return written(yaml.safe_dump(tree, allow_unicode=True, sort_keys=False))
