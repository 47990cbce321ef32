"""Describing: a node tells others what its types are made of, by get_type_description."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import InterfaceError, RosNameError
from studio.ros.names import split_type_name
from studio.ros.types.learning import described, sources

if TYPE_CHECKING:
    from studio.ros.hosting import Host
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

SERVICE_TYPE = "type_description_interfaces/srv/GetTypeDescription"
SERVICE_NAME = "get_type_description"
START_PARAMETER = "start_type_description_service"


def serve_descriptions(host: Host, types: TypeLibrary) -> None:
    """Answer what the types of a library are made of, in the name of a node."""

    def answer(request: MessageValue, response: MessageValue) -> MessageValue:
        return fill_description(types, request, response)

    name = f"{host.get_fully_qualified_name()}/{SERVICE_NAME}"
    host.create_service(types.service(SERVICE_TYPE), name, answer)


def fill_description(
    types: TypeLibrary, request: MessageValue, response: MessageValue
) -> MessageValue:
    """Fill a response with the description that is asked for, or the reason why there is none."""
    name = request.type_name
    try:
        split_type_name(name)
        known_hash = types.hash_of(name)
        if request.type_hash and request.type_hash != known_hash:
            response.failure_reason = f"{name} has the hash {known_hash} here"
            return response
        response.type_description = described(types, name)
        if request.include_type_sources:
            response.type_sources = sources(types, name)
    except (InterfaceError, RosNameError) as error:
        response.failure_reason = str(error)
        return response
    response.successful = True
    return response
