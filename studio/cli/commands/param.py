"""`studio param`: list, read and set the parameters of nodes."""

from __future__ import annotations

import argparse
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from studio.cli.own_node import named_node, nodes_serving, own_node, print_error
from studio.cli.terminal import harmless, shown
from studio.cli.verbs import Verbs
from studio.cli.wire import add_wire_options
from studio.errors import WireError

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.ros.parameter_client import ParameterClient
    from studio.ros.parameters.parameter import Parameter
    from studio.ros.types.classes import MessageValue


_Use: TypeAlias = "Callable[[ParameterClient, argparse.Namespace], int]"
_LIST_TYPE = "rcl_interfaces/srv/ListParameters"


def add(parser: argparse.ArgumentParser) -> None:
    """Add the verbs of `param` to the parser."""
    verbs = Verbs(parser)
    listing = verbs.add("list", _list, "name the parameters of a node, or of all")
    listing.add_argument("node_name", metavar="NODE", nargs="?")
    listing.add_argument("--include-hidden-nodes", action="store_true", dest="hidden")
    listing.add_argument("--param-prefixes", nargs="+", default=[], metavar="PREFIX")
    listing.add_argument("--param-type", action="store_true", help="with their types")
    listing.add_argument(
        "--filter", type=_pattern, metavar="REGEX", help="those whose names begin so"
    )
    add_wire_options(listing)
    get = _add_of_node(verbs, "get", _get, "print the value of a parameter")
    get.add_argument("parameter_name", metavar="NAME")
    get.add_argument("--hide-type", action="store_true", help="the value alone")
    change = _add_of_node(verbs, "set", _set, "give a parameter a value")
    change.add_argument("parameter_name", metavar="NAME")
    change.add_argument("value", metavar="VALUE", help="as YAML; negative numbers are values")
    dump = _add_of_node(verbs, "dump", _dump, "print all parameters as a file of them")
    dump.add_argument("--output-dir", type=Path, metavar="DIR", help="write NODE.yaml there")
    dump.add_argument("--print", action="store_true", help="as is: it is printed")
    load = _add_of_node(verbs, "load", _load, "set the parameters that a file names")
    load.add_argument("parameter_file", metavar="FILE", type=Path)
    load.add_argument("--no-use-wildcard", action="store_true", help="not what * stands for")
    delete = _add_of_node(verbs, "delete", _delete, "take a parameter away from a node")
    delete.add_argument("parameter_name", metavar="NAME")
    describe = _add_of_node(verbs, "describe", _describe, "print what parameters are for")
    describe.add_argument("parameter_names", metavar="NAME", nargs="+")


def _pattern(text: str) -> re.Pattern[str]:
    try:
        return re.compile(text)
    except re.error as error:
        raise argparse.ArgumentTypeError(f'"{text}" is no regular expression: {error}') from None


def _add_of_node(verbs: Verbs, name: str, use: _Use, summary: str) -> argparse.ArgumentParser:
    def run(options: argparse.Namespace) -> int:
        from studio.ros.parameter_client import ParameterClient

        with own_node(options) as own:
            node = named_node(own, options)
            if node is None:
                return 1
            with ParameterClient(own.node, node) as remote:
                return use(remote, options)

    verb = verbs.add(name, run, summary)
    verb.add_argument("node_name", metavar="NODE")
    add_wire_options(verb)
    return verb


def _list(options: argparse.Namespace) -> int:
    from studio.ros.parameter_client import ParameterClient

    with own_node(options) as own:
        if options.node_name is None:
            nodes = nodes_serving(own, "list_parameters", _LIST_TYPE, hidden=options.hidden)
        else:
            node = named_node(own, options)
            if node is None:
                return 1
            nodes = [node]
        for node in nodes:
            try:
                with ParameterClient(own.node, node) as remote:
                    lines = _lines(remote, options)
            except WireError as error:
                print_error(str(error))
                continue
            head = "" if options.node_name is not None else f"{node}:\n"
            print(shown(head + "".join(lines)), end="")
    return 0


def _lines(remote: ParameterClient, options: argparse.Namespace) -> list[str]:
    names = remote.names(options.param_prefixes)
    if options.filter is not None:
        names = [name for name in names if options.filter.match(name)]
    if not options.param_type:
        return [f"  {name}\n" for name in names]
    return [f"  {one.name} (type: {one.type_.label})\n" for one in remote.get(names)]


def _get(remote: ParameterClient, options: argparse.Namespace) -> int:
    from studio.ros.parameters.parameter import ParameterType

    found = remote.get([options.parameter_name])
    if not found or found[0].type_ is ParameterType.NOT_SET:
        print("Parameter not set", file=sys.stderr)
        return 1
    value = shown(str(found[0].value))
    print(value if options.hide_type else f"{_label(found[0])} {value}")
    return 0


def _label(parameter: Parameter) -> str:
    """Return the type as `ros2 param get` prints it: `Integer value is:`, `Double values are:`."""
    prefix, _, is_array = parameter.type_.name.partition("_")
    noun = {"BOOL": "Boolean"}.get(prefix, prefix.capitalize())
    return f"{noun} values are:" if is_array else f"{noun} value is:"


def _set(remote: ParameterClient, options: argparse.Namespace) -> int:
    from studio.ros.parameters.parameter import Parameter, read_value

    value = read_value(options.value.strip())
    (result,) = remote.set([Parameter(options.parameter_name, value=value)]) or [None]
    return _report(result, "Set parameter successful", "Setting parameter failed")


def _delete(remote: ParameterClient, options: argparse.Namespace) -> int:
    from studio.ros.parameters.parameter import Parameter

    (result,) = remote.set([Parameter(options.parameter_name)]) or [None]
    return _report(result, "Deleted parameter successfully", "Deleting parameter failed")


def _report(result: MessageValue | None, done: str, failed: str) -> int:
    """Return the result, with the node's reason; None when it did not answer."""
    reason = f": {harmless(result.reason)}" if result is not None and result.reason else ""
    if result is not None and result.successful:
        print(f"{done}{reason}")
        return 0
    print(f"{failed}{reason}", file=sys.stderr)
    return 1


def _dump(remote: ParameterClient, options: argparse.Namespace) -> int:
    text = remote.dump()
    if options.output_dir is None:
        print(shown(text), end="")
        return 0
    path = options.output_dir.expanduser() / f"{remote.remote.strip('/').replace('/', '__')}.yaml"
    _write(path, text)
    print(f"Saving to: {path}")
    return 0


def _write(path: Path, text: str) -> None:
    from studio.errors import SettingsError

    try:
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise SettingsError(f"{path} cannot be written: {error.strerror}.") from error


def _load(remote: ParameterClient, options: argparse.Namespace) -> int:
    from studio.ros.types.files import read_text

    path = options.parameter_file.expanduser()
    results = remote.load(read_text(path), str(path), wildcards=not options.no_use_wildcard)
    if not results:
        print(f"{path} says nothing of {remote.remote}", file=sys.stderr)
        return 1
    return max(
        _report(
            result,
            f"Set parameter {one.name} successful",
            f"Setting parameter {one.name} failed",
        )
        for one, result in results
    )


def _describe(remote: ParameterClient, options: argparse.Namespace) -> int:

    for one in remote.describe(options.parameter_names):
        print(shown("\n".join(_description_lines(one))))
    return 0


def _description_lines(descriptor: Any) -> list[str]:  # noqa: ANN401  # of the node's distribution
    """Write a `ParameterDescriptor`; constraints only where there are some."""
    lines = [f"Parameter name: {descriptor.name}", f"  Type: {_type_label(descriptor.type)}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    constraints = _constraints(descriptor)
    return [*lines, "  Constraints:", *constraints] if constraints else lines


def _type_label(number: int) -> str:
    from studio.ros.parameters.parameter import ParameterType

    return ParameterType(number).label if number in set(ParameterType) else f"unknown ({number})"


def _constraints(descriptor: Any) -> list[str]:  # noqa: ANN401
    lines = ["    Read only: true"] if descriptor.read_only else []
    for one in (*descriptor.floating_point_range, *descriptor.integer_range):
        lines += [f"    Min value: {one.from_value}", f"    Max value: {one.to_value}"]
        if one.step:
            lines.append(f"    Step: {one.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return lines
