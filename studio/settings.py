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

XACRO_MEMORY_BYTES = 1 << 30
ROBOT_MEMORY_BYTES = 4 << 30
EXPANSION_TIMEOUT_S = 2.8
"""The parent's time for a run of short files; the evaluator's own of 2 s ends sooner."""
MESH_TIMEOUT_S = 60.0
XACRO_ENVIRONMENT = frozenset({"ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "ROS_DOMAIN_ID"})
"""Variables that `$(env)` and `$(optenv)` of an untrusted file may read."""
SOURCE_SIZE_LIMIT_BYTES = 20 << 20
MESH_SIZE_LIMIT_BYTES = 512 << 20
ZIP_SIZE_LIMIT_BYTES = 1 << 30
"""Unpacked size of an opened zip."""
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
class Settings:
    """Settings from the command line; see `studio --help`."""

    host: str = DEFAULT_HOST
    port: int | None = None
    """None: the default port or the next free one."""
    token: str | None = None
    """None: no token is asked for (`--no-token`, loopback only)."""
    data_folder: Path = Path()
    package_paths: tuple[Path, ...] = ()
    trusted: bool = False
    open_browser: bool = True
    wire: WireChoice = WireChoice()


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
