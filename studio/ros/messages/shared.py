"""The types that all nodes of a process share, so that a class is the same wherever it is met."""

from __future__ import annotations

import os
from functools import cache
from typing import TYPE_CHECKING

from studio.ros.messages.own_types import take_own_types
from studio.ros.names import full_type_name
from studio.ros.profiles import JAZZY, PROFILES
from studio.ros.types.library import ActionType, ServiceType, TypeLibrary

if TYPE_CHECKING:
    from studio.ros.types.classes import MessageValue


@cache
def types_of(distro: str) -> TypeLibrary:
    """Give the library of a distribution, one for the whole process, with the user's own types.

    Raises:
        WireSettingsError: The environment names types that are not there, or not sound.
    """
    library = TypeLibrary(distro)
    take_own_types(library)
    return library


def shared_types() -> TypeLibrary:
    """Give the library of the distribution that ROS_DISTRO names, or of Jazzy."""
    named = os.environ.get("ROS_DISTRO", "").lower()
    return types_of(named if named in PROFILES else JAZZY.distro)


def message(name: str) -> type[MessageValue]:
    """Give the class of a message by its name, `std_msgs/msg/String` or `std_msgs/String`.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return shared_types().message(full_type_name(name, "msg"))


def service(name: str) -> ServiceType:
    """Give a service by its name, `std_srvs/srv/Trigger`.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return shared_types().service(full_type_name(name, "srv"))


def action(name: str) -> ActionType:
    """Give an action by its name, `turtlesim/action/RotateAbsolute`.

    Raises:
        UnknownTypeError: It, or what it is made of, is not known.
    """
    return shared_types().action(full_type_name(name, "action"))
