"""Ports, folders and limits: every number that a user or a deployment may want to change."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass
from pathlib import Path

from studio.errors import DataFolderError

DEFAULT_HOST = "127.0.0.1"
DEFAULT_PORT = 8765
LOOPBACK_HOSTS = frozenset({"127.0.0.1", "localhost", "::1"})
ANY_HOST = "0.0.0.0"
ANY_HOSTS = frozenset({ANY_HOST, "::"})
"""To listen at all addresses of this machine."""

XACRO_MEMORY_BYTES = 1 << 30
SHARED_MEMORY_BYTES = 256 << 20
"""Of each evaluator that the copies of a class share."""
ROBOT_MEMORY_BYTES = 4 << 30
PLUGIN_MEMORY_BYTES = 2 << 30
"""Of the process of one display of the user's own."""
PLUGIN_LOAD_S = 10.0
PLUGIN_STEP_S = 1.0
"""Time that such a display has to take in messages and to draw."""
EXPANSION_TIMEOUT_S = 2.8
"""The parent's time for a run of short files; the evaluator's own of 2 s ends sooner."""
MESH_TIMEOUT_S = 60.0
XACRO_ENVIRONMENT = frozenset({"ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_DOMAIN_ID"})
"""Variables that `$(env)` and `$(optenv)` of an untrusted file may read."""
SOURCE_SIZE_LIMIT_BYTES = 20 << 20
MESH_SIZE_LIMIT_BYTES = 512 << 20
ZIP_SIZE_LIMIT_BYTES = 1 << 30
"""Unpacked size of an opened zip."""
REWIND_BYTES = 256 << 20
"""Memory for the last minutes of the topics that somebody looks at."""
UPLOADS_QUOTA_BYTES = 4 << 30
"""Limit of all opened zips in the data folder together."""


@dataclass(frozen=True, slots=True)
class WireChoice:
    """How ROS 2 is joined, as on the command line; ROS's environment fills what is left open."""

    router: str = "auto"
    """`auto`: start a router unless one answers; `off`: never; else where to start or join one."""
    connect: tuple[str, ...] = ()
    """Zenoh endpoints of routers; empty: the usual one of this machine."""
    domain: int | None = None
    distro: str = ""
    """Whose types and hashes are used; empty: those of ROS_DISTRO."""


@dataclass(frozen=True, slots=True)
class TlsChoice:
    """How the page is encrypted; `certificate` None: by one that the studio makes itself."""

    certificate: Path | None = None
    key: Path | None = None


@dataclass(frozen=True, slots=True)
class Settings:
    """Settings from the command line; see `studio --help`."""

    host: str = DEFAULT_HOST
    port: int | None = None
    """None: the default port or the next free one."""
    token: str = ""
    """Makes an owner of who has it."""
    guests: bool = False
    """Whether all who reach the port may look, without a token."""
    shared: bool = False
    """Whether a class is begun at the start."""
    via: tuple[str, ...] = ()
    """Lines of the relays that share the class, too."""
    via_topics: tuple[str, ...] = ()
    """Patterns of the topics that relays may pass on; none: all."""
    base_path: str = ""
    """The path below which the page is reached, as `/studio`."""
    proxies: frozenset[str] = frozenset()
    """Addresses of proxies that tell who asks."""
    public_url: str = ""
    """The address that others use, when it is another than this machine's."""
    tls: TlsChoice | None = None
    data_folder: Path = Path()
    package_paths: tuple[Path, ...] = ()
    lesson_folders: tuple[Path, ...] = ()
    """Each a lesson, or with a lesson in each folder of it."""
    display_folders: tuple[Path, ...] = ()
    """Each Python file in one is a display of the owner's own, which is run."""
    run_folders: tuple[Path, ...] = ()
    """Whose launch files and nodes the owner may run, and whose programs edit, out of the page."""
    rewind_bytes: int = REWIND_BYTES
    """Memory for the last minutes of the ROS system; 0: they are not kept."""
    trusted: bool = False
    open_browser: bool = True
    wire: WireChoice = WireChoice()

    @property
    def is_private(self) -> bool:
        """Whether the page is offered to this machine's own browsers alone.

        It decides what the owner may reach from the page, never who the owner is.
        """
        offered = self.shared or self.guests or self.proxies or self.public_url
        return self.host in LOOPBACK_HOSTS and not offered


def repository_or_wheel(folder: str) -> Path:
    """Find `frontend_assets` or `models`: in the checkout, else inside the installed package."""
    package = Path(__file__).resolve().parent
    checkout = package.parent / folder
    if (package.parent / "pyproject.toml").is_file() and checkout.is_dir():
        return checkout
    return package / f"_{folder}"


def data_folder(chosen: Path | None) -> Path:
    """Return the data folder: `--data-dir`, else STUDIO_DATA_DIR, else the platform's own; made.

    Raises:
        DataFolderError: It cannot be made or is not writable.
    """
    from platformdirs import user_data_path  # noqa: PLC0415 - not every command needs it

    named = os.environ.get("STUDIO_DATA_DIR")
    folder = chosen or (Path(named) if named else user_data_path("robot-description-studio"))
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError as error:
        raise DataFolderError(str(folder), error.strerror or "cannot be made") from error
    if not os.access(folder, os.W_OK):
        raise DataFolderError(str(folder), "not writable")
    return folder.resolve()


def mesh_worker_count() -> int:
    """Processes for meshes: one less than the cores, 1 to 4."""
    cores = os.cpu_count() or 2
    return max(1, min(4, cores - (sys.platform != "win32")))
