"""Options of commands that read robot descriptions and start the server, and what they mean."""

from __future__ import annotations

import argparse
import gc
import os
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from studio.cli.joining import JOINING, add_joining_options
from studio.errors import SettingsError
from studio.settings import ANY_HOST, DEFAULT_HOST, DEFAULT_PORT, REWIND_BYTES

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.settings import Settings, TlsChoice


_HIGHEST_PORT = 65535
_REWIND_MB_MAX = 65536
_NEW_OBJECTS_MAX = 5_000
"""Between two garbage collections: an edit makes up to a thousand objects, which are collected
afterwards, when nobody waits."""


def add_server_options(parser: argparse.ArgumentParser) -> None:
    """Options of every command that starts the server."""
    parser.add_argument("--host", help="address to listen on (default: this machine only)")
    parser.add_argument(
        "--port", type=_port, help=f"port to listen on (default: {DEFAULT_PORT} or the next free)"
    )
    parser.add_argument("--no-browser", action="store_true", help="open no browser window")
    _add_sharing_options(parser.add_argument_group("sharing it with others").add_argument)
    wire = parser.add_argument_group(JOINING)
    add_joining_options(
        wire.add_argument,
        "auto",
        "where no router answers: auto starts one in this process for this machine, off starts "
        "none (default: auto)",
    )
    wire.add_argument(
        "--rewind-mb",
        type=_megabytes,
        default=REWIND_BYTES >> 20,
        metavar="N",
        help="memory for the last minutes of what is looked at, to go back to; 0 keeps nothing "
        f"(default: {REWIND_BYTES >> 20})",
    )
    parser.add_argument(
        "--lessons",
        action="append",
        type=Path,
        default=[],
        metavar="FOLDER",
        help="show the lessons of this folder; may be given again",
    )
    parser.add_argument(
        "--displays",
        action="append",
        type=Path,
        default=[],
        metavar="FOLDER",
        help="run each .py file in this folder as a display of your own; may be given again",
    )
    parser.add_argument(
        "--allow-run",
        action="append",
        type=Path,
        default=[],
        metavar="FOLDER",
        help="let yourself, and nobody else, run launch files and nodes of this folder out of the "
        "page, and edit its Python files; may be given again",
    )
    add_read_options(parser)


def add_page_options(parser: argparse.ArgumentParser) -> None:
    """Options of a command that serves browsers the page of another studio."""
    parser.add_argument("--host", help="address to listen on (default: this machine only)")
    parser.add_argument(
        "--port", type=_port, help=f"port to listen on (default: {DEFAULT_PORT} or the next free)"
    )
    _add_front_options(parser.add_argument)
    _add_data_option(parser)


def page_settings(options: argparse.Namespace, *, keeps: bool = True) -> Settings:
    """Return the settings of a command with `add_page_options`.

    If it `keeps` nothing, the data folder is not made, and empty unless it was given.

    Raises:
        SettingsError: They do not go together, or the data folder cannot be used.
    """
    from studio.server.front import base_path, proxy_addresses
    from studio.settings import Settings, data_folder

    given: Path | None = options.data_dir
    public_url = _public_url(options.public_url)
    return Settings(
        host=options.host or DEFAULT_HOST,
        port=options.port,
        base_path=base_path(options.base_path or urlsplit(public_url).path),
        proxies=proxy_addresses(options.trusted_proxy),
        public_url=public_url,
        tls=_tls(options),
        data_folder=data_folder(given)
        if keeps
        else (given.expanduser().resolve() if given else Path()),
    )


def _add_sharing_options(add: Callable[..., object]) -> None:
    add(
        "--share",
        action="store_true",
        help="let others on this network join with a code, and print it",
    )
    add(
        "--via",
        action="append",
        default=[],
        metavar="LINE",
        help="also share by this relay, with the line that `studio relay` prints; may be given "
        "again",
    )
    add(
        "--via-topics",
        action="append",
        default=[],
        metavar="PATTERN",
        help="topics that relays may pass on, as '/tf*' (default: all); may be given again",
    )
    add("--viewer-link", action="store_true", help="print an address for viewers, too")
    add(
        "--no-token",
        action="store_true",
        help="let all who reach the port look, without a token; the owner's address has it still",
    )
    _add_front_options(add)


def _add_front_options(add: Callable[..., object]) -> None:
    add("--tls-cert", type=Path, metavar="FILE", help="encrypt with this certificate (PEM) and ...")
    add("--tls-key", type=Path, metavar="FILE", help="... its key")
    add(
        "--tls",
        choices=("self",),
        help="encrypt with a certificate that the studio makes, and print its fingerprint",
    )
    add("--base-path", default="", metavar="PATH", help="path behind a proxy, as /studio")
    add(
        "--trusted-proxy",
        action="append",
        default=[],
        metavar="ADDRESS",
        help="proxy whose X-Forwarded-For, -Proto and -Host are believed; may be given again",
    )
    add("--public-url", default="", metavar="URL", help="address that others use to come here")


def add_read_options(parser: argparse.ArgumentParser) -> None:
    """Options of every command that reads robot descriptions."""
    parser.add_argument(
        "--package-path",
        action="append",
        default=[],
        metavar="DIR",
        help="also find packages here, read-only; may be given again",
    )
    _add_data_option(parser)
    parser.add_argument(
        "--trust",
        action="store_true",
        help="for your own files, on this machine only: $(env) sees every environment variable, "
        "not only those of ROS; expressions and what may be read stay as they are",
    )


def _add_data_option(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--data-dir", type=Path, metavar="DIR", help="where working copies and caches live"
    )


def _port(text: str) -> int:
    number = int(text)
    if not 0 <= number <= _HIGHEST_PORT:
        raise argparse.ArgumentTypeError(f"{number} is no port: 0 to {_HIGHEST_PORT}")
    return number


def _megabytes(text: str) -> int:
    number = int(text)
    if not 0 <= number <= _REWIND_MB_MAX:
        raise argparse.ArgumentTypeError(f"{number} is not from 0 to {_REWIND_MB_MAX} megabytes")
    return number


def package_paths(options: argparse.Namespace) -> tuple[Path, ...]:
    """Return all `--package-path`, each of which may hold several, as PATH does."""
    parts = (part for given in options.package_path for part in given.split(os.pathsep))
    return tuple(Path(part).expanduser() for part in parts if part)


def server_settings(options: argparse.Namespace) -> Settings:
    """Return the settings of a command that starts the server.

    Raises:
        SettingsError: The data folder cannot be used.
        WireSettingsError: `--router` or `--connect` is no endpoint.
        RelayKeyError: `--via` is no line of a relay.
    """
    from studio.ros.wire.endpoints import parse_endpoint
    from studio.server.credentials import new_token
    from studio.server.front import base_path, proxy_addresses
    from studio.settings import Settings, WireChoice, data_folder

    router = () if options.router in {"auto", "off"} else (options.router,)
    for endpoint in (*options.connect, *router):
        parse_endpoint(endpoint)
    if options.via:
        from studio.server.relays.keys import parse_relay_line

        for line in options.via:
            parse_relay_line(line)
        if not options.share:
            raise SettingsError("--via shares a class by a relay: give --share, too.")
    public_url = _public_url(options.public_url)
    return Settings(
        host=options.host or (ANY_HOST if options.share else DEFAULT_HOST),
        port=options.port,
        token=new_token(),
        guests=options.no_token,
        shared=options.share,
        via=tuple(options.via),
        via_topics=tuple(options.via_topics),
        base_path=base_path(options.base_path or urlsplit(public_url).path),
        proxies=proxy_addresses(options.trusted_proxy),
        public_url=public_url,
        tls=_tls(options),
        data_folder=data_folder(options.data_dir),
        package_paths=package_paths(options),
        lesson_folders=tuple(one.expanduser().absolute() for one in options.lessons),
        display_folders=_folders("--displays", options.displays),
        run_folders=_run_folders(options.allow_run),
        rewind_bytes=options.rewind_mb << 20,
        trusted=options.trust,
        open_browser=not options.no_browser,
        wire=WireChoice(options.router, tuple(options.connect), options.domain),
    )


def _folders(option: str, given: Sequence[Path]) -> tuple[Path, ...]:
    """Return the folders that an option names.

    Raises:
        SettingsError: One is no folder.
    """
    folders = tuple(one.expanduser().absolute() for one in given)
    for folder in folders:
        if not folder.is_dir():
            raise SettingsError(f"{option} takes a folder, and {folder} is none.")
    return folders


def _run_folders(given: Sequence[Path]) -> tuple[Path, ...]:
    """Return the folders of `--allow-run`.

    Raises:
        SettingsError: One is no folder, or holds far more than a workspace.
    """
    from studio.packages.roots import is_too_wide

    folders = tuple(one.resolve() for one in _folders("--allow-run", given))
    for folder in folders:
        if is_too_wide(folder):
            raise SettingsError(
                f"--allow-run {folder} would let everything there be run: name the folder of a "
                "workspace inside it."
            )
    return folders


def _public_url(text: str) -> str:
    """Return the address with a slash at its end, or an empty text.

    Raises:
        SettingsError: It is no address of a page.
    """
    if not text:
        return ""
    parts = urlsplit(text)
    if parts.scheme not in {"http", "https"} or not parts.hostname or parts.query:
        raise SettingsError(f"--public-url takes an address as https://host/path, not {text!r}.")
    return text if text.endswith("/") else f"{text}/"


def _tls(options: argparse.Namespace) -> TlsChoice | None:
    """Return how the page is encrypted.

    Raises:
        SettingsError: A certificate without its key, or two choices at once.
    """
    from studio.settings import TlsChoice

    given = (options.tls_cert, options.tls_key)
    if (given[0] is None) != (given[1] is None):
        raise SettingsError("--tls-cert and --tls-key belong together: give both.")
    if options.tls and given[0] is not None:
        raise SettingsError("Choose one of --tls self and --tls-cert.")
    if options.tls:
        return TlsChoice()
    return None if given[0] is None else TlsChoice(*given)


def serve(
    options: argparse.Namespace,
    settings: Settings,
    path: Path,
    arguments: dict[str, str],
    nodes: Callable[[], None] | None = None,
) -> None:
    """Open a path and serve its page until the command is stopped.

    `nodes` starts nodes once the page is served, and the studio joins them.
    """
    gc.disable()  # everything imported stays: collections meanwhile cost a third
    from studio.server.launch import Opening, launch

    gc.freeze()
    gc.set_threshold(_NEW_OBJECTS_MAX)
    gc.enable()
    view: Path | None = getattr(options, "view", None)
    opening = Opening(
        path,
        arguments,
        nodes,
        joins_ros=nodes is not None,
        view=view.expanduser().absolute() if view else None,
        fixed_frame=getattr(options, "fixed_frame", ""),
        fullscreen=getattr(options, "fullscreen", False),
    )
    launch(settings, opening, viewer_link=options.viewer_link)


def read_mappings(arguments: Sequence[str]) -> dict[str, str]:
    """Return `name:=value` by name, as xacro reads it: outer blanks dropped, no `_name`.

    Raises:
        SettingsError: An argument has more than one `:=`.
    """
    found: dict[str, str] = {}
    for argument in arguments:
        name, *values = (part.strip() for part in argument.split(":="))
        if len(values) != 1:
            raise SettingsError(f"{argument} is no argument: write it as name:=value.")
        is_hidden = len(name) > 1 and name[0] == "_" and name[1] != "_"
        if name and values[0] and not is_hidden:
            found[name] = values[0]
    return found
