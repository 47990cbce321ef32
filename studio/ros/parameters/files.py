"""Files of parameters, as `ros2 param dump` writes them and `--params-file` reads them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from studio.errors import InvalidParameterTypeError, ParameterFileError, RosArgumentError
from studio.ros.parameters.parameter import Parameter, ParameterType
from studio.ros.types.classes import shown
from studio.ros.types.yaml_texts import read_yaml, write_yaml

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

PARAMETERS_KEY = "ros__parameters"
LEVELS_MAX = 64


def write_parameters(node: str, parameters: Mapping[str, Parameter]) -> str:
    """Write the parameters of a node by its full name; those without a value are left out."""
    tree: dict[str, Any] = {}
    for name in sorted(parameters):
        if parameters[name].type_ is not ParameterType.NOT_SET:
            _insert(tree, name, parameters[name].value)
    return write_yaml({node: {PARAMETERS_KEY: tree}})


def read_parameters(
    text: str,
    node: str,
    where: str = "The file of parameters",
    *,
    wildcards: bool = True,
) -> list[Parameter]:
    """Read what a file has for the node of that full name; `where` names the file in errors.

    A name may be whole (`/ns/node`), in levels (`ns: node:`), or, with `wildcards`, hold `*` for
    one part and `**` for any number of them. What is lower in the file comes before what is above
    it.

    Raises:
        ParameterFileError: The file is not valid, or a value fits no parameter.
    """
    found: dict[str, Parameter] = {}
    for path, values in _sections(_tree_of(text, where), "", where):
        if ("*" not in path or wildcards) and _matches(_parts(path), _parts(node)):
            found |= _section(values, where)
    return list(found.values())


def read_all_parameters(text: str, where: str, *, wildcards: bool) -> list[Parameter]:
    """Read what a file has for nodes of any name; names with `*` only with `wildcards`, and first.

    Raises:
        ParameterFileError: The file is not valid, or a value fits no parameter.
    """
    sections = list(_sections(_tree_of(text, where), "", where))
    found: dict[str, Parameter] = {}
    for wanted in (True, False) if wildcards else (False,):
        for path, values in sections:
            if ("*" in path) is wanted:
                found |= _section(values, where)
    return list(found.values())


def read_overrides(
    files: Iterable[str], values: Iterable[tuple[str, str]], node: str
) -> list[Parameter]:
    """Return the parameters that a command line gives to the node of that full name.

    Args:
        files: Of parameters, the last one counts.
        values: Names and values in YAML, which come before those of files.
        node: Its full name.

    Raises:
        ParameterFileError: A file cannot be read, or is none of parameters.
        InvalidParameterTypeError: A value is of no type that parameters have.
        RosArgumentError: A value is no YAML.
    """
    found: dict[str, Parameter] = {}
    for file in files:
        found |= {one.name: one for one in read_parameters(text_of(file), node, file)}
    for name, text in values:
        found[name] = Parameter(name, value=_value(name, text))
    return list(found.values())


def _tree_of(text: str, where: str) -> dict[object, object]:
    try:
        tree = read_yaml(text, "it")
    except ValueError as error:
        raise ParameterFileError(where, str(error)) from None
    if not isinstance(tree, dict):
        raise ParameterFileError(where, f"names of nodes are expected, not {shown(tree)}")
    return cast("dict[object, object]", tree)


def _section(values: object, where: str) -> dict[str, Parameter]:
    return {name: _made(name, value, where) for name, value in _flat(values, "", where, 0)}


def text_of(file: str) -> str:
    """Return the text of a file of parameters.

    Raises:
        ParameterFileError: It cannot be read.
    """
    try:
        return Path(file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ParameterFileError(file, f"it cannot be read ({error})") from None


def _value(name: str, text: str) -> Any:  # noqa: ANN401 - whatever YAML holds
    try:
        return read_yaml(text, "its value")
    except ValueError as error:
        raise RosArgumentError(f"{name}:={text}", str(error)) from None


def _insert(tree: dict[str, Any], name: str, value: object) -> None:
    """Put `a.b` into the group `a`, or under its whole name where `a` holds a value itself."""
    group, _, rest = name.partition(".")
    below = tree.setdefault(group, {}) if rest else None
    if isinstance(below, dict) and all(name.split(".")):
        _insert(cast("dict[str, Any]", below), rest, value)
    else:
        tree[name] = value


def _sections(tree: dict[object, object], above: str, where: str) -> Iterator[tuple[str, object]]:
    """Walk down levels of names to each `ros__parameters`."""
    if above.count("/") > LEVELS_MAX:
        raise ParameterFileError(where, f"names lie deeper than {LEVELS_MAX} levels")
    for key, value in tree.items():
        if key == PARAMETERS_KEY:
            yield above, value
        elif isinstance(value, dict):
            path = f"{above}/{str(key).strip('/')}"
            yield from _sections(cast("dict[object, object]", value), path, where)
        else:
            name = f"{above}/{key}"
            raise ParameterFileError(where, f"{name} needs a {PARAMETERS_KEY} with its values")


def _flat(values: object, above: str, where: str, level: int) -> Iterator[tuple[str, object]]:
    if not isinstance(values, dict):
        raise ParameterFileError(where, f"{PARAMETERS_KEY} holds {shown(values)}, no parameters")
    if level > LEVELS_MAX:
        raise ParameterFileError(where, f"parameters lie deeper than {LEVELS_MAX} levels")
    for key, value in cast("dict[object, object]", values).items():
        name = f"{above}{key}"
        if isinstance(value, dict):
            yield from _flat(cast("object", value), f"{name}.", where, level + 1)
        else:
            yield name, value


def _made(name: str, value: object, where: str) -> Parameter:
    if value is None:
        raise ParameterFileError(where, f"the parameter {name} has no value")
    try:
        return Parameter(name, value=value)
    except InvalidParameterTypeError as error:
        raise ParameterFileError(where, str(error).rstrip(".")) from None


def _parts(path: str) -> list[str]:
    return path.strip("/").split("/")


def _matches(pattern: list[str], parts: list[str]) -> bool:
    """Whether a name in parts fits; every `**` doubles no work, as each is tried from the left."""
    reached = {0}
    for one in pattern:
        if one == "**":
            reached = set(range(min(reached), len(parts) + 1)) if reached else set[int]()
        else:
            reached = {
                place + 1 for place in reached if place < len(parts) and one in ("*", parts[place])
            }
    return len(parts) in reached
