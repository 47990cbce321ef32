"""`.rviz` files on the command line: read before anything starts, and the robot that one names."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from studio.errors import RvizConfigError, UnreadableFileError

if TYPE_CHECKING:
    import argparse

    from studio.rviz.config import RvizConfig

_PACKAGE = "package://"


@dataclass(frozen=True)
class ViewFile:
    """An `.rviz` file that was read."""

    path: Path
    config: RvizConfig


def add_view_options(parser: argparse.ArgumentParser) -> None:
    """Options that RViz has, too."""
    group = parser.add_argument_group("the 3D view")
    group.add_argument(
        "-d",
        "--display-config",
        "--rviz",
        dest="view",
        type=Path,
        metavar="FILE",
        help="show what a .rviz file says; without PATH also the robot that it names",
    )
    group.add_argument(
        "-f", "--fixed-frame", default="", metavar="FRAME", help="draw in this frame"
    )
    group.add_argument(
        "--fullscreen", action="store_true", help="begin with the 3D view alone on the page"
    )


def is_view(path: Path | None) -> bool:
    """Whether a path is of a `.rviz` file, and not of a robot."""
    from studio.rviz.config_text import ENDINGS

    return path is not None and path.name.endswith(ENDINGS)


def read_view(path: Path) -> ViewFile:
    """Return an `.rviz` file.

    Raises:
        UnreadableFileError: It is not there, or cannot be read.
        RvizConfigError: It is no such file.
    """
    from studio.rviz.config import read_config

    path = path.expanduser().absolute()
    try:
        text = path.read_bytes().decode("utf-8")
    except OSError as error:
        raise UnreadableFileError(str(path), error.strerror or "cannot be read.") from error
    except UnicodeDecodeError as error:
        raise RvizConfigError("it is no text in UTF-8", name=str(path)) from error
    try:
        config, _ = read_config(text)
    except RvizConfigError as error:
        raise RvizConfigError(error.reason, error.line, str(path)) from error
    return ViewFile(path, config)


def robot_of(view: ViewFile, data_folder: Path) -> Path:
    """Return the file of the robot that a view shows.

    Where its RobotModel names no file that is there, the description is awaited on its topic: the
    document is then a link of the fixed frame's name, for the displays to stand in.
    """
    for one in view.config.displays:
        if one.kind == "RobotModel" and one.values.get("Description Source") == "File":
            found = _named(str(one.values.get("Description File", "")), view.path.parent)
            if found is not None:
                return found
    return _bare_frame(view.config.fixed_frame or "map", data_folder)


def _named(uri: str, folder: Path) -> Path | None:
    """Return the file of a path or of a `package://` URI beside a view, if it is there."""
    if not uri:
        return None
    if not uri.startswith(_PACKAGE):
        path = folder / Path(uri.removeprefix("file://")).expanduser()
        return path if path.is_file() else None
    name, _, inner = uri.removeprefix(_PACKAGE).partition("/")
    for above in (folder, *folder.parents):
        for package in (above, above / name):
            path = package / inner
            if package.name == name and (package / "package.xml").is_file() and path.is_file():
                return path
    return None


def _bare_frame(frame: str, data_folder: Path) -> Path:
    from xml.sax.saxutils import quoteattr

    from studio.packages.received_texts import new_untitled

    return new_untitled(
        data_folder, f'<robot name="view">\n  <link name={quoteattr(frame)}/>\n</robot>\n'
    )
