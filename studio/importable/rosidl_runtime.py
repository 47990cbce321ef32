"""rosidl_runtime_py: messages as dicts, YAML and CSV, and types by their names."""

from __future__ import annotations

import importlib
from collections import OrderedDict
from typing import TYPE_CHECKING, Any, Final, cast

from studio.errors import MessageValueError, RosNameError, UnknownTypeError
from studio.packages.passing import passed_packages
from studio.ros.messages import action, message, service, shared_types
from studio.ros.names import full_type_name, split_type_name
from studio.ros.types.classes import MessageValue, attributes_of, class_of_field, definition_of
from studio.ros.types.convert import Brevity, from_dict, to_csv, to_dict, to_yaml
from studio.ros.types.library import ActionType, ServiceType

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


_LOOK_UPS: Final = {"msg": message, "srv": service, "action": action}


def message_to_ordereddict(  # rosidl_runtime_py's
    msg: MessageValue,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> OrderedDict[str, Any]:
    """Return a message as ordered dicts, lists, numbers and texts."""
    return _ordered(to_dict(msg, Brevity(no_arr, no_str, truncate_length)))


def message_to_yaml(  # rosidl_runtime_py's
    msg: MessageValue,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
    flow_style: bool = False,
) -> str:
    """Return a message in YAML."""
    return to_yaml(msg, Brevity(no_arr, no_str, truncate_length), flow=flow_style)


def message_to_csv(
    msg: MessageValue,
    *,
    truncate_length: int | None = None,
    no_arr: bool = False,
    no_str: bool = False,
) -> str:
    """Return the values of a message in one line."""
    return to_csv(msg, Brevity(no_arr, no_str, truncate_length))


def set_message_fields(msg: MessageValue, values: Mapping[str, Any]) -> list[Any]:
    """Set fields of a message from plain values.

    Raises:
        AttributeError: It has no such field, or the values are no set of fields.
        AssertionError: A field does not take its value.
    """
    fields = {field.name: field for field in definition_of(msg).fields}
    names = dict(zip(fields, attributes_of(msg), strict=True))
    for name, value in values.items():
        if name not in fields:
            raise AttributeError(f"'{type(msg).__name__}' object has no attribute '{name}'")
        try:
            made = from_dict(type(msg), {name: value})
        except MessageValueError as error:
            raise AssertionError(str(error)) from None
        setattr(msg, names[name], getattr(made, names[name]))
    return []


def get_message_slot_types(msg: MessageValue) -> OrderedDict[str, str]:
    """Return the types of a message's fields by name."""
    return OrderedDict(
        (field.name, class_of_field(msg, field).__name__ if field.type.nested else str(field.type))
        for field in definition_of(msg).fields
    )


def get_message(identifier: str) -> type[MessageValue]:
    """Return the class of `std_msgs/msg/String`.

    Raises:
        ValueError: It is no name of a message.
        ModuleNotFoundError: No such message is known.
    """
    return _looked_up(identifier, "msg")


def get_service(identifier: str) -> ServiceType:
    """Return the service `std_srvs/srv/Trigger`.

    Raises:
        ValueError: It is no name of a service.
        ModuleNotFoundError: No such service is known.
    """
    return _looked_up(identifier, "srv")


def get_action(identifier: str) -> ActionType:
    """Return the action `example_interfaces/action/Fibonacci`.

    Raises:
        ValueError: It is no name of an action.
        ModuleNotFoundError: No such action is known.
    """
    return _looked_up(identifier, "action")


def get_interface(identifier: str) -> Any:  # noqa: ANN401
    """Return a message, service or action by its full name.

    Raises:
        ValueError: It is no full name.
        ModuleNotFoundError: No such type is known.
    """
    return _looked_up(identifier, *_LOOK_UPS)


def is_message(obj: object) -> bool:
    """Whether it is a message, or the class of one."""
    kind = obj if isinstance(obj, type) else type(obj)
    return issubclass(kind, MessageValue)


def is_service(obj: object) -> bool:
    """Whether it is a service."""
    return isinstance(obj, ServiceType)


def is_action(obj: object) -> bool:
    """Whether it is an action."""
    return isinstance(obj, ActionType)


def get_interface_packages() -> dict[str, str]:
    """Return the packages that have types; of the studio's own no folder is told."""
    return dict.fromkeys(sorted({name.partition("/")[0] for name in shared_types().names()}), "")


def get_interfaces(package_names: Iterable[str] = ()) -> dict[str, list[str]]:
    """Return the types of packages, `msg/String`, by package; of all without a name."""
    wanted = set(package_names)
    found: dict[str, list[str]] = {}
    for name in shared_types().names():
        package, _, rest = name.partition("/")
        if not wanted or package in wanted:
            found.setdefault(package, []).append(rest)
    return found


def get_interface_path(interface_name: str) -> str:
    """Return the file of a type.

    Raises:
        LookupError: No folder of a workspace has it.
    """
    package, kind, name = split_type_name(full_type_name(interface_name))
    folder = passed_packages().get(package)
    file = folder / kind / f"{name}.{kind}" if folder is not None else None
    if file is None or not file.is_file():
        raise LookupError(f"Could not find the interface '{interface_name}'")
    return str(file)


def _looked_up(identifier: str, *kinds: str) -> Any:  # noqa: ANN401
    """Return a type, whose module is imported: so the workspace's types are taken."""
    try:
        package, kind, _ = split_type_name(identifier)
    except RosNameError:
        package, kind = "", ""
    if kind not in kinds:
        wanted = " or ".join(kinds)
        raise ValueError(f"Expected the full name of a {wanted} type, got '{identifier}'")
    importlib.import_module(f"{package}.{kind}")
    try:
        return _LOOK_UPS[kind](identifier)
    except UnknownTypeError as error:
        raise AttributeError(str(error)) from None


def _ordered(value: Any) -> Any:  # noqa: ANN401
    if isinstance(value, dict):
        rows = cast("dict[str, Any]", value)
        return OrderedDict((name, _ordered(one)) for name, one in rows.items())
    if isinstance(value, list):
        return [_ordered(one) for one in cast("list[Any]", value)]
    return value
