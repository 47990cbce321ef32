"""Starts the studio: binds a port, serves until a signal ends it, and opens a browser at it."""

from __future__ import annotations

import asyncio
import gc
import logging
import os
import secrets
import shutil
import subprocess
import sys
import threading
import webbrowser
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from html import escape
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, Final
from urllib.parse import urlsplit

from studio.classroom.classroom import Classroom, Reach
from studio.classroom.qr_code import qr_lines
from studio.description import checks as text_checks
from studio.documents.engine import Engine
from studio.errors import SettingsError, StudioError
from studio.files import write_whole
from studio.packages import lint as package_checks
from studio.problems import whys
from studio.protocol.roles import Role
from studio.robot import checks as robot_checks
from studio.scene import CLIENT_PATH, viser_client
from studio.server.app import make_app
from studio.server.assets import CHECK_TEXTS, Assets, check_texts
from studio.server.credentials import Credentials, cookie_key
from studio.server.front import Front
from studio.server.origin import KnownHosts, is_loopback
from studio.server.ports import (
    FULL_SCREEN,
    bind,
    lan_addresses,
    page_address,
    port_of,
    with_code,
    with_token,
)
from studio.server.progress_bar import ProgressBar
from studio.server.relays.origin import Origin, door_of
from studio.server.server import Server
from studio.settings import DEFAULT_PORT, LOOPBACK_HOSTS, Settings, repository_or_wheel
from studio.system import raise_descriptor_limit

if TYPE_CHECKING:
    import socket
    from collections.abc import Callable


_REDIRECT: Final = Template("""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0;url=$address">
<title>Robot description studio</title>
</head>
<body><p><a href="$address">Go to the studio</a></p></body>
</html>
""")
_ASK_TIMEOUT_S: Final = 5.0


def has_display() -> bool:
    """Whether a window would be seen: not in a container, nor behind a plain ssh."""
    if sys.platform in {"win32", "darwin"}:
        return "SSH_CONNECTION" not in os.environ
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


class Window:
    """The browser window that a run of the studio opens.

    Every user of a machine sees the command lines of all programs: a browser is given the name of a
    file that only its owner may read, and the file leads to the address.
    """

    def __init__(self, data_folder: Path) -> None:
        self._data_folder = data_folder
        self._file: Path | None = None

    def show(self, address: str, opens: Callable[[str], object] = webbrowser.open) -> None:
        """Open an address that is secret, without waiting for the browser."""
        threading.Thread(target=self._show, args=(address, opens), daemon=True).start()

    def close(self) -> None:
        """Remove the file; the next start on this folder writes it again."""
        if self._file is not None:
            self._file.unlink(missing_ok=True)

    def _show(self, address: str, opens: Callable[[str], object]) -> None:
        folder = readable_folder(_default_browser(), Path.home(), self._data_folder)
        self._file = folder / f"robot-description-studio-{os.getpid()}.html"
        text = _REDIRECT.substitute(address=escape(address, quote=True))
        try:
            write_whole(self._file, text.encode(), mode=0o600)
        except OSError:  # the printed address opens the page as well
            return
        opens(self._file.as_uri())


def readable_folder(browser: str, home: Path, data_folder: Path) -> Path:
    """Return a folder that a browser can read: one from a snap sees no hidden folders.

    Args:
        browser: Its desktop entry, as `firefox_firefox.desktop`, whose first part is the snap.
        home: The user's own folder.
        data_folder: The folder for all other browsers.
    """
    snap, separator, _ = browser.partition("_")
    common = home / "snap" / snap / "common"
    return common if separator and common.is_dir() else data_folder


def _default_browser() -> str:
    """Return the desktop entry of the usual browser; empty where that is not known."""
    settings = shutil.which("xdg-settings")
    if settings is None:
        return ""
    asked = [settings, "get", "default-web-browser"]
    try:
        found = subprocess.run(
            asked, capture_output=True, text=True, timeout=_ASK_TIMEOUT_S, check=False
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return found.stdout.strip()


@dataclass(frozen=True, slots=True)
class Opening:
    """What to open first, and a callback for when it is open and the address is printed."""

    path: Path
    arguments: dict[str, str]
    then: Callable[[], None] | None = None
    joins_ros: bool = False
    """Connect with ROS 2 afterwards, even where the studio was not connected before."""
    view: Path | None = None
    """An `.rviz` file to show."""
    fixed_frame: str = ""
    """To draw in; empty: as the document has it, or the file says."""
    fullscreen: bool = False
    """Begin with the 3D view alone on the page."""


def launch(settings: Settings, opening: Opening, *, viewer_link: bool = False) -> None:
    """Run the studio until a signal ends it.

    Args:
        settings: What the command line decided.
        opening: The first document.
        viewer_link: Whether to print the address for viewers, too.

    Raises:
        StudioError: It cannot start, or what to open first cannot be opened.
    """
    logging.basicConfig(
        stream=sys.stderr, level=logging.WARNING, format="%(levelname)s %(message)s"
    )
    if settings.trusted and (viewer_link or not settings.is_private):
        raise SettingsError(
            "--trust is for you alone: leave it out where others come, with --host, --share, "
            "--viewer-link, --no-token, --public-url or --trusted-proxy."
        )
    raise_descriptor_limit()
    key = cookie_key(settings.data_folder, datetime.now(UTC).timestamp())
    credentials = Credentials(settings.token, key, settings.data_folder, guests=settings.guests)
    with bind(settings.host, settings.port) as listener:
        place = place_of(settings, port_of(listener))
        for sentence in remarks(settings, place.port, is_root=_is_root()):
            _warn(sentence)
        if place.reach.fingerprint and not settings.shared:
            _print(_FINGERPRINT.format(place.reach.fingerprint))
        roles = (Role.PRESENTER, Role.GUEST) if viewer_link else (Role.PRESENTER,)
        links = [with_token(place.address_for(role), credentials.token_of(role)) for role in roles]
        if opening.fullscreen:
            links = [f"{one}&{FULL_SCREEN}" for one in links]
        visit = _Visit(opening, links, place)
        visit.run(settings, credentials, listener)


@dataclass(frozen=True, slots=True)
class Place:
    """Where the studio is reached.

    Attributes:
        port: The port that it listens on.
        address: Of the page, for a browser on this machine.
        reach: Where others find it.
        front: Reads requests.
        tls: The files of certificate and key; None: it is not encrypted.
    """

    port: int
    address: str
    reach: Reach
    front: Front
    tls: tuple[Path, Path] | None = None

    def address_for(self, role: Role) -> str:
        """Return the address that somebody opens: viewers may be at other machines."""
        if role is Role.PRESENTER or self.reach.only_here:
            return self.address
        return self.reach.addresses[0]


_FINGERPRINT: Final = "SHA-256 of its certificate: {}"


def place_of(settings: Settings, port: int) -> Place:
    """Return where a studio with these settings is reached, once it has its port.

    Raises:
        SettingsError: The certificate cannot be used.
        DataFolderError: One of its own cannot be written.
    """
    tls = settings.tls is not None
    base = settings.base_path
    here = page_address(settings.host, port, base, tls=tls)
    found = lan_addresses(settings.host, port, base, tls=tls)
    addresses = (settings.public_url,) if settings.public_url else found or (here,)
    names = [urlsplit(one).hostname or "" for one in (here, *found)]
    files, print_ = _tls_files(settings, [*names, *LOOPBACK_HOSTS])
    why_not = "Start the studio without --trust to share it." if settings.trusted else ""
    known = KnownHosts.of(settings.host, urlsplit(settings.public_url).hostname or "")
    return Place(
        port,
        here,
        Reach(
            addresses,
            not found and not settings.public_url,
            print_,
            why_not,
            settings.host,
            (urlsplit(found[0]).hostname or "") if found else "",
        ),
        Front(known, port, base, settings.proxies),
        files,
    )


def _tls_files(settings: Settings, names: list[str]) -> tuple[tuple[Path, Path] | None, str]:
    """Return the files of certificate and key, and the fingerprint of one of our own."""
    if settings.tls is None:
        return None, ""
    from studio.server.certificate import (  # noqa: PLC0415 - not every studio needs it
        check_pair,
        fingerprint,
        own_certificate,
    )

    if settings.tls.certificate is not None and settings.tls.key is not None:
        check_pair(settings.tls.certificate, settings.tls.key)
        return (settings.tls.certificate, settings.tls.key), ""
    files = own_certificate(settings.data_folder, names)
    return files, fingerprint(files[0])


def remarks(settings: Settings, port: int, *, is_root: bool = False) -> list[str]:
    """Return sentences about what is unusual in how the studio runs and where it listens."""
    sentences: list[str] = []
    if is_root:
        sentences.append(
            "The studio runs as root, and so does all that a file or a visitor makes it do: "
            "start it as an ordinary user."
        )
    if settings.port is None and port != DEFAULT_PORT:
        sentences.append(
            f"Port {DEFAULT_PORT} is taken by another program: this studio uses {port}."
        )
    if not is_loopback(settings.host) and settings.tls is None:
        sentences.append(
            "Other machines reach this studio, and the connection is not encrypted: "
            "whoever has the address with its token can change and save files. Encrypt it with "
            "--tls self."
        )
    if settings.public_url.startswith("https://") and not (settings.proxies or settings.tls):
        sentences.append(
            "--public-url is of https, and no proxy is trusted: name its address by "
            "--trusted-proxy, or cookies are sent without encryption as well."
        )
    return sentences


def _is_root() -> bool:
    return os.name == "posix" and os.geteuid() == 0


class _Visit:
    """The life beside the server: the engine, and the opening of the first document."""

    def __init__(self, opening: Opening, links: list[str], place: Place) -> None:
        self._opening, self._links, self._place = opening, links, place
        self._opens: asyncio.Task[None] | None = None
        self._failure: Exception | None = None

    def run(self, settings: Settings, credentials: Credentials, listener: socket.socket) -> None:
        """Serve until the end.

        Raises:
            Exception: What ended it early; a StudioError unless it is a bug.
        """
        place = self._place
        kept = settings.data_folder / f"class-{place.port}.json"
        self._classroom = Classroom(kept, place.reach)
        self._engine = Engine(settings, self._classroom)
        self._window = Window(settings.data_folder)
        self._settings, self._credentials = settings, credentials
        client = viser_client()
        assets = Assets(
            repository_or_wheel("frontend_assets"),
            {
                CLIENT_PATH: lambda: client,
                CHECK_TEXTS: lambda: check_texts(whys(robot_checks, text_checks, package_checks)),
            },
        )
        session = secrets.token_hex(8)
        app = make_app(self._engine, assets, credentials, session, place.front)
        self._server = Server(app, self, place.tls)
        topics = settings.via_topics
        self._origin = Origin(self._engine, self._classroom, session, topics, self._joined)
        self._classroom.end_pages = self._end_pages
        self._server.run(sockets=[listener])
        if self._failure is not None:
            raise self._failure

    def _joined(self, address: str) -> None:
        """Tell where others join by a relay."""
        admission = self._classroom.admission
        if not admission.open:  # a code of a class that is paused opens nothing
            _print(f"Relay: {door_of(address)}")
            return
        _print(f"Relay: {door_of(address)}  Code: {admission.code}")
        _print(f"   or: {address}join?code={admission.link}")

    def _end_pages(self, person: str) -> None:
        self._server.server_state.crowd.end_person(person)
        self._origin.end_person(person)

    async def begin(self) -> None:
        """Start the engine."""
        await self._engine.start()

    async def answering(self) -> None:
        """Open the first document beside the server, which must handle signals meanwhile."""
        self._opens = asyncio.create_task(self._open())

    async def end(self) -> None:
        """End the engine with all its workers."""
        if self._opens is not None:
            self._opens.cancel()
            with suppress(asyncio.CancelledError):
                await self._opens
        self._window.close()
        await self._origin.close()
        await self._engine.close()

    async def _open(self) -> None:
        bar = ProgressBar(sys.stderr)
        try:
            opening = self._opening
            name = await self._engine.open_path(opening.path, opening.arguments, bar.show)
            await self._show(name)
        except Exception as error:  # noqa: BLE001 - `run` raises it, once all has ended
            self._failure = error
            self._server.should_exit = True
            return
        finally:
            bar.end()
        gc.collect()
        gc.freeze()  # the objects of the start stay: a collection over all of them takes 40 ms
        for name, link in zip(("Studio", "Viewer"), self._links, strict=False):
            _print(f"{name}: {link}")
        if self._settings.shared:
            await self._share()
        await self._origin.begin(self._settings.via, _warn)
        if self._settings.open_browser and has_display():
            self._open_browser()
        if opening.then is not None:
            opening.then()
        self._engine.rejoin(always=opening.joins_ros)

    async def _show(self, document: str) -> None:
        """Show what the command line says of the 3D view.

        Raises:
            RvizConfigError: The file cannot be shown.
        """
        opening, one = self._opening, self._engine.document(document)
        if opening.view is not None:
            opened = await one.configs.open_path(opening.view)
            kept = ", ".join(each.what for each in opened.losses if each.reason in _SAID_OF_A_VIEW)
            if kept:
                _warn(f"{opened.name} is shown; what is not here is only kept: {kept}.")
        if opening.fixed_frame:
            await one.live.fix(opening.fixed_frame)

    async def _share(self) -> None:
        """Begin the class, or go on with it, and print how others join."""
        try:
            await self._classroom.start()
        except StudioError as error:
            _warn(str(error))
        for line in invitation(self._classroom):
            _print(line)

    def _open_browser(self) -> None:
        code = self._credentials.new_code()
        address = with_code(self._place.address, code)
        self._window.show(f"{address}&{FULL_SCREEN}" if self._opening.fullscreen else address)


_SAID_OF_A_VIEW: Final = ("no_display", "no_tool", "no_view", "no_panel")
"""What of an `.rviz` file a terminal names; the page tells all."""


def invitation(classroom: Classroom) -> list[str]:
    """Return what a terminal shows of a class: address, code, QR code and fingerprint."""
    reach = classroom.reach
    first, *others = reach.addresses
    lines = [f"Class: {first}  Code: {classroom.admission.code}"]
    lines += [f"   or: {other}" for other in others]
    if reach.fingerprint:
        lines.append(_FINGERPRINT.format(reach.fingerprint))
    return [*lines, qr_lines(classroom.link)]


def _print(line: str) -> None:
    """Print one line at once: the parent process may read it from a pipe."""
    with suppress(OSError):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()


def _warn(line: str) -> None:
    sys.stderr.write(f"studio: {line}\n")
