"""Data keys: domain, name, type and hash of a topic or service as one Zenoh key, and back."""

from __future__ import annotations

from dataclasses import dataclass

from studio.errors import RosNameError
from studio.ros.names import check_full_name, split_type_name

DOMAIN_MAX = 2**32 - 1
_DDS = "dds_::"


@dataclass(frozen=True, slots=True)
class DataKey:
    """What a data key says; `name` is fully qualified, a service's `type_name` that of the whole.

    The hash is part of the key, so that a wrong one meets nobody: take it from the graph.
    """

    domain: int
    name: str
    type_name: str
    type_hash: str

    def __str__(self) -> str:
        body = self.name.removeprefix("/")
        return f"{self.domain}/{body}/{dds_type(self.type_name)}/{self.type_hash}"


def whatever_type_key(domain: int, name: str) -> str:
    """Give the key expression of a name with any type and hash."""
    return f"{domain}/{name.removeprefix('/')}/*/*"


def parse_key(key: str) -> DataKey:
    """Read a data key.

    Raises:
        RosNameError: It is no data key of rmw_zenoh.
    """
    domain, _, rest = key.partition("/")
    chunks = rest.rsplit("/", 2)
    if len(chunks) != 3 or "/@" in rest:
        raise RosNameError(key, "a data key is domain/name/type/hash")
    body, type_name, type_hash = chunks
    return DataKey(
        parse_domain(domain, key), check_full_name("/" + body), ros_type(type_name), type_hash
    )


def parse_domain(text: str, key: str) -> int:
    """Read a ROS_DOMAIN_ID as keys carry it.

    Raises:
        RosNameError: It is no such number; `key` is named.
    """
    if not (text.isascii() and text.isdigit() and len(text) <= 10 and int(text) <= DOMAIN_MAX):
        raise RosNameError(key, "a key begins with the number of its domain")
    return int(text)


def dds_type(type_name: str) -> str:
    """Turn `std_msgs/msg/String` into `std_msgs::msg::dds_::String_`."""
    package, kind, base = type_name.split("/")
    return f"{package}::{kind}::{_DDS}{base}_"


def ros_type(dds_name: str) -> str:
    """Turn `std_msgs::msg::dds_::String_` into `std_msgs/msg/String`.

    Raises:
        RosNameError: It is no type's name as DDS writes it.
    """
    if _DDS not in dds_name or not dds_name.endswith("_"):
        raise RosNameError(dds_name, "a type on the wire is written package::msg::dds_::Type_")
    name = dds_name.replace(_DDS, "", 1).removesuffix("_").replace("::", "/")
    split_type_name(name)
    return name
