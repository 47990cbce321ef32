"""Runs a relay: its key, its addresses, and its server, until a signal ends it."""

from __future__ import annotations

import logging
import sys
from dataclasses import replace
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Final
from urllib.parse import urlsplit

from studio.description import checks as text_checks
from studio.errors import DataFolderError
from studio.files import write_whole
from studio.packages import lint as package_checks
from studio.problems import whys
from studio.robot import checks as robot_checks
from studio.ros.wire.certificates import new_secret
from studio.ros.wire.zenoh import use_few_threads
from studio.scene import CLIENT_PATH, viser_client
from studio.server.assets import CHECK_TEXTS, Assets, check_texts
from studio.server.launch import place_of, remarks
from studio.server.origin import KnownHosts, is_loopback
from studio.server.ports import bind, bracketed, port_of
from studio.server.relays.keys import RelayIdentity, listening_endpoint
from studio.server.relays.relay import Relay
from studio.server.server import Server
from studio.settings import ANY_HOSTS, DEFAULT_HOST, repository_or_wheel
from studio.system import raise_descriptor_limit

if TYPE_CHECKING:
    from pathlib import Path

    from studio.ros.wire.endpoints import Endpoint
    from studio.server.launch import Place
    from studio.settings import Settings

_KEY_FILE: Final = "relay.key"


def serve_relay(settings: Settings, listen: str, name: str, *, new_key: bool) -> None:
    """Serve until a signal ends it, and print the line for studios and the address for people.

    Args:
        settings: What the command line decided of the page.
        listen: Where studios dial in.
        name: By which studios and browsers find this machine; empty: its first address.
        new_key: Whether to make another key.

    Raises:
        StudioError: It cannot listen.
    """
    logging.basicConfig(
        stream=sys.stderr, level=logging.WARNING, format="%(levelname)s %(message)s"
    )
    use_few_threads()
    raise_descriptor_limit()
    endpoint = listening_endpoint(listen)
    identity = relay_identity(settings.data_folder, anew=new_key)
    with bind(settings.host, settings.port) as listener:
        place = place_of(settings, port_of(listener))
        for sentence in _remarks(settings, place.port):
            sys.stderr.write(f"studio: {sentence}\n")
        address = _address(settings, place, name)
        names = KnownHosts.of(settings.host, urlsplit(address).hostname or "")
        client = viser_client()
        assets = Assets(
            repository_or_wheel("frontend_assets"),
            {
                CLIENT_PATH: lambda: client,
                CHECK_TEXTS: lambda: check_texts(whys(robot_checks, text_checks, package_checks)),
            },
        )
        relay = Relay(
            endpoint=listen,
            identity=identity,
            address=address,
            assets=assets,
            hosts=names,
            port=place.port,
            base=settings.base_path,
            proxies=settings.proxies,
            on_listening=lambda: _print_lines(endpoint, identity, address, name),
        )
        server = Server(relay, relay, place.tls)
        relay.crowd = server.server_state.crowd
        server.run(sockets=[listener])


def _remarks(settings: Settings, port: int) -> list[str]:
    """Return sentences about what is unusual: nobody has a token here, or saves files."""
    found = remarks(replace(settings, host=DEFAULT_HOST), port)
    is_here = is_loopback(settings.host)
    if is_here and not settings.public_url:
        found.append(
            "Only this machine finds the page: others need --host 0.0.0.0, or a proxy, as "
            "`studio relay --print nginx` has it."
        )
    if not (is_here or settings.tls or settings.proxies):
        found.append(
            "The page is not encrypted: whoever is on the way reads what people see and type. Use "
            "--tls self, --tls-cert, or a proxy, as `studio relay --print nginx` has it."
        )
    return found


def relay_identity(data_folder: Path, *, anew: bool = False) -> RelayIdentity:
    """Return the relay's identity, whose secret is in a file that only its owner may read.

    Raises:
        DataFolderError: It cannot be kept, or is none.
    """
    path = data_folder / _KEY_FILE
    try:
        if not anew and path.exists():
            return RelayIdentity(path.read_text("ascii").strip())
        secret = new_secret()
        write_whole(path, secret.encode(), mode=0o600)
    except ValueError as error:
        reason = "it holds no key: put it back as it was, or make another with --new-key"
        raise DataFolderError(str(path), reason) from error
    except OSError as error:
        raise DataFolderError(str(path), error.strerror or str(error)) from error
    return RelayIdentity(secret)


def _address(settings: Settings, place: Place, name: str) -> str:
    """Return where browsers come."""
    if settings.public_url or not name:
        return place.reach.addresses[0]
    parts = urlsplit(place.reach.addresses[0])
    port = f":{parts.port}" if parts.port else ""
    return parts._replace(netloc=f"{bracketed(name)}{port}").geturl()


def _print_lines(endpoint: Endpoint, identity: RelayIdentity, address: str, name: str) -> None:
    own = "" if endpoint.host in ANY_HOSTS else endpoint.host
    shown = bracketed(name or own or urlsplit(address).hostname or "")
    line = f"tls/{shown}:{endpoint.port}#{identity.key}"
    began = datetime.now(UTC).strftime("%H:%M UTC")
    sys.stdout.write(
        f"Relay: {line}\n"
        f"People join at {address} once a studio is here (started {began}):\n"
        f"  studio open ROBOT --share --via '{line}'\n"
    )
    sys.stdout.flush()
