"""Parameters as launch files give them to nodes, with the types that launch_ros gives them."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast, get_args, get_origin

import yaml

from studio.errors import SubstitutionFailure
from studio.launch.plan import Where
from studio.launch.vocabulary.places import here
from studio.launch.vocabulary.requests import ParameterSet
from studio.launch.vocabulary.substitutions import value_of_yaml
from studio.launch.vocabulary.texts import SomeText, Substitution, as_bool, is_unknown, perform

if TYPE_CHECKING:
    from studio.launch.vocabulary.context import LaunchContext

DEPTH_MAX = 32
VALUES_MAX = 10_000
FILE_MAX_BYTES = 4 << 20


class ParameterValue:
    """A value with the type that it is to have; None: as YAML takes its text."""

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value, self.value_type = value, value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value.

        Raises:
            SubstitutionFailure: Its text is not of that type.
        """
        return typed(_text_or_value(context, self.value), self.value_type, "a parameter")


class Parameter:
    """A parameter by its name."""

    def __init__(
        self,
        name: SomeText,
        value: Any,
        *,
        description: str = "",
        value_type: Any = None,
    ) -> None:
        self.name = name
        self.value = value if value_type is None else ParameterValue(value, value_type=value_type)

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return its name and value."""
        name = perform(context, self.name)
        return name, value_of(context, self.value, name)


class ParameterFile:
    """A file of parameters, in whose text substitutions may stand."""

    def __init__(self, param_file: SomeText, *, allow_substs: Any = False) -> None:
        self.where = here()
        self.param_file, self.allow_substs = param_file, allow_substs

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path of the file, or of a copy with its substitutions made."""
        return Path(file_set(context, self).path)

    def cleanup(self) -> None:
        """Temporary files end with the launch."""


def parameter_sets(context: LaunchContext, parameters: Any) -> list[ParameterSet]:
    """Return what `parameters` of a node comes to.

    Raises:
        TypeError: It is no list of dicts, files and parameters.
        SubstitutionFailure: A value is not known, or of the wrong type.
    """
    if parameters is None:
        return []
    if isinstance(parameters, str | os.PathLike | Mapping | Substitution):
        raise TypeError(
            f"parameters is {type(parameters).__name__}: it must be a list, write "  # pyright: ignore[reportUnknownArgumentType]
            "parameters=[...] around it"
        )
    sets: list[ParameterSet] = []
    for one in cast("Iterable[Any]", parameters):
        sets += _sets_of(context, one)
    return sets


def _sets_of(context: LaunchContext, one: Any) -> list[ParameterSet]:
    if hasattr(one, "is_placeholder"):
        return []
    if isinstance(one, Mapping):
        values: dict[str, Any] = {}
        flatten(context, cast("Mapping[Any, Any]", one), "", values)
        return [ParameterSet(values)]
    if isinstance(one, Parameter):
        return [ParameterSet(dict([one.evaluate(context)]))]
    is_file = isinstance(one, ParameterFile)
    found = file_set(context, one) if is_file else ParameterSet(None, perform(context, one))
    if is_unknown(found.path) and not context.host.plans:
        where = one.where if isinstance(one, ParameterFile | Substitution) else Where()
        sentence = f"not supported: the file of parameters {found.path} is left out"
        context.host.unsupported("ParameterFile", sentence, where)
        return []
    return [found]


def flatten(
    context: LaunchContext, values: Mapping[Any, Any], above: str, into: dict[str, Any]
) -> None:
    """Put a dict's values under names whose levels are parted by dots.

    Raises:
        SubstitutionFailure: A value is not known, of the wrong type, or there are too many.
    """
    if above.count(".") > DEPTH_MAX or len(into) > VALUES_MAX:
        raise SubstitutionFailure(
            f"parameters are deeper than {DEPTH_MAX} levels or more than {VALUES_MAX}: give fewer"
        )
    for key, value in values.items():
        name = f"{above}{key if isinstance(key, str) else perform(context, key)}"
        if isinstance(value, Mapping):
            flatten(context, cast("Mapping[Any, Any]", value), f"{name}.", into)
        else:
            into[name] = value_of(context, value, name)


def value_of(context: LaunchContext, value: Any, name: str) -> Any:
    """Return a parameter's value: a substitution's text becomes what YAML makes of it.

    Raises:
        SubstitutionFailure: It is of no type that parameters have.
    """
    if isinstance(value, ParameterValue):
        return typed(_text_or_value(context, value.value), value.value_type, name)
    if hasattr(value, "is_placeholder"):
        return perform(context, value)
    if value is None or isinstance(value, str | bool | int | float | bytes):
        return value
    if isinstance(value, Substitution):
        return typed(perform(context, value), None, name)
    if isinstance(value, os.PathLike):
        return os.fspath(cast("os.PathLike[str]", value))
    if isinstance(value, Iterable):
        return _of_list(context, list(cast("Iterable[Any]", value)), name)
    raise SubstitutionFailure(
        f"the parameter {name} is {type(value).__name__}: it must be a bool, a number, a text, or "
        "a list of one of these"
    )


def _of_list(context: LaunchContext, values: list[Any], name: str) -> Any:
    """A list with a substitution in it is one text, as ROS has it; any other is an array."""
    if any(isinstance(one, Substitution) for one in values) and all(
        isinstance(one, Substitution | str) for one in values
    ):
        return typed(perform(context, values), None, name)
    items = [
        perform(context, one)
        if isinstance(one, list | tuple | Substitution)
        else value_of(context, one, name)
        for one in values
    ]
    if items and all(isinstance(one, int | float) and not isinstance(one, bool) for one in items):
        return [float(one) for one in items] if any(isinstance(o, float) for o in items) else items
    if len({type(one) for one in items}) > 1:
        raise SubstitutionFailure(f"the parameter {name} is a list of several types: use one")
    return items


def _text_or_value(context: LaunchContext, value: Any) -> Any:
    if isinstance(value, str | bool | int | float) or value is None:
        return value
    if isinstance(value, list | tuple) and not any(
        isinstance(one, Substitution) for one in cast("list[Any]", value)
    ):
        return list(cast("list[Any]", value))
    return perform(context, value)


def typed(value: Any, kind: Any, name: str) -> Any:
    """Return a text as a value of a type; None: as YAML takes it.

    Raises:
        SubstitutionFailure: It is not of that type, or no YAML.
    """
    if kind is str:
        return value if isinstance(value, str) else str(value)
    if not isinstance(value, str) or is_unknown(value):
        return (
            value if kind is None or isinstance(value, list | str) else _checked(value, kind, name)
        )
    try:
        found = value_of_yaml(value)
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise SubstitutionFailure(
            f"the value of the parameter {name} is no YAML: where it is meant to be a text, write "
            "ParameterValue(..., value_type=str) around it"
        ) from error
    if kind is not None:
        return _checked(found, kind, name)
    if found is None and value:
        return value
    if isinstance(found, dict | tuple) or not isinstance(
        found, bool | int | float | str | list | bytes | None
    ):
        return value
    return found  # pyright: ignore[reportUnknownVariableType]


def _checked(value: Any, kind: Any, name: str) -> Any:
    if get_origin(kind) is list:
        (inner,) = get_args(kind) or (str,)
        values = cast("list[Any]", value) if isinstance(value, list) else [value]
        return [_checked(one, inner, name) for one in values]
    if kind is float and isinstance(value, int) and not isinstance(value, bool):
        return float(value)
    if isinstance(kind, type) and not isinstance(value, kind):  # pyright: ignore
        raise SubstitutionFailure(f"the parameter {name} is {value!r}, which is no {kind.__name__}")
    return value


def file_set(context: LaunchContext, one: ParameterFile) -> ParameterSet:
    """Return the file; with `allow_substs` a copy in which they are made.

    Raises:
        SubstitutionFailure: It cannot be read, or a substitution in it has no value.
    """
    path = perform(context, one.param_file)
    if not as_bool(context, one.allow_substs, "allow_substs") or is_unknown(path):
        return ParameterSet(None, path)
    from studio.launch.frontends.texts import parse_text  # noqa: PLC0415
    from studio.launch.vocabulary.temporary import written  # noqa: PLC0415

    text = perform(context, parse_text(read_text(path)))
    return ParameterSet(None, written(text, Path(path).name, path))


def read_text(path: str) -> str:
    """Return the text of a file of parameters.

    Raises:
        SubstitutionFailure: It cannot be read, or is too large.
    """
    try:
        with Path(path).open("rb") as file:
            data = file.read(FILE_MAX_BYTES + 1)
    except OSError as error:
        raise SubstitutionFailure(
            f"the file of parameters {path} cannot be read ({error.strerror}): is it installed by "
            "setup.py or CMakeLists.txt under that name?"
        ) from error
    if len(data) > FILE_MAX_BYTES:
        raise SubstitutionFailure(f"{path} is larger than {FILE_MAX_BYTES >> 20} MB")
    return data.decode(errors="replace")
