"""Opening the wire: join the router that is there, or start one of our own and join that."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.errors import (
    ForeignEndpointError,
    NoRouterError,
    NotAdmittedError,
    RouterNotStartedError,
    WireError,
)
from studio.ros.wire.endpoints import Endpoint, parse_endpoint
from studio.ros.wire.probing import Answer, probe
from studio.ros.wire.router import EmbeddedRouter, RouterChoice, router_choice, start_router
from studio.ros.wire.session import WireSession, open_session
from studio.ros.wire.threads import take_few_threads

if TYPE_CHECKING:
    from studio.ros.types.library import TypeLibrary
    from studio.ros.wire.settings import WireSettings

_RACES_MAX = 5
"""How often the one who wins a race for the endpoint may be gone when we come to join."""

_ROUTERS = frozenset({Answer.ZENOH, Answer.TLS})


def open_wire(
    settings: WireSettings, router: str = "auto", types: TypeLibrary | None = None
) -> WireSession:
    """Open a session that every node of this process shares; close it.

    Args:
        settings: Where the router is, and what is spoken there.
        router: `auto` starts a router where none answers if only this machine can reach the
            endpoint; `off` starts none; an endpoint is joined, and started where none answers.
        types: A library that is shared; one of the distribution is made without.

    Raises:
        NoRouterError: None answers, and none may be started.
        NotAdmittedError: A router answers and wants another name, password or certificate.
        ForeignEndpointError: Something that is no Zenoh holds the endpoint.
        RouterNotStartedError: None answers, and the endpoint cannot be listened at.
        WireSettingsError: The settings cannot be.
    """
    take_few_threads()
    choice = router_choice(router)
    if choice.endpoint is not None:
        settings = replace(settings, connect=(choice.endpoint.text,))
    for _ in range(_RACES_MAX - 1):
        try:
            return _open_once(settings, choice, types)
        except NoRouterError:
            if _place_for_router(settings, choice) is None:
                raise
    return _open_once(settings, choice, types)


def _open_once(
    settings: WireSettings, choice: RouterChoice, types: TypeLibrary | None
) -> WireSession:
    found = _answer_at(settings)
    router = _router_of_our_own(settings, choice) if found is Answer.NOBODY else None
    try:
        return open_session(settings, types, router)
    except WireError as error:
        if router is not None:
            router.close()
        # A router that ended just now answered, too: it is there no more when asked again.
        refuses = isinstance(error, NoRouterError) and found in _ROUTERS
        if refuses and _answer_at(settings) in _ROUTERS:
            raise NotAdmittedError(settings.connect[0]) from None
        raise


def _router_of_our_own(settings: WireSettings, choice: RouterChoice) -> EmbeddedRouter | None:
    """Start a router where nobody is, None where none is wanted."""
    place = _place_for_router(settings, choice)
    if place is None:
        return None
    try:
        return start_router(place, settings.overrides, settings.router_config_file)
    except RouterNotStartedError as error:
        if error.held:
            return None  # another process was quicker: it is joined
        raise


def _answer_at(settings: WireSettings) -> Answer:
    """Look at the only endpoint; of several, Zenoh takes whichever answers."""
    if len(settings.connect) != 1:
        return Answer.UNKNOWN
    found = probe(parse_endpoint(settings.connect[0]))
    if found is Answer.OTHER:
        raise ForeignEndpointError(settings.connect[0])
    return found


def _place_for_router(settings: WireSettings, choice: RouterChoice) -> Endpoint | None:
    if not choice.starts:
        return None
    if choice.endpoint is not None:
        return choice.endpoint
    places = [parse_endpoint(text) for text in settings.connect]
    if len(places) == 1 and places[0].is_loopback and places[0].is_stream:
        return places[0]
    return None
