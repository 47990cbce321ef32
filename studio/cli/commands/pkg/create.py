"""`studio pkg create`: make a new package, as `ros2 pkg create` does."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.terminal import harmless
from studio.errors import SettingsError
from studio.packages.creation.licenses import LICENSES, SHORT, known_license
from studio.packages.creation.making import create_package
from studio.packages.creation.new_package import (
    BUILD_TYPES,
    NO_DESCRIPTION,
    NO_LICENSE,
    NewPackage,
)

if TYPE_CHECKING:
    import argparse

    from studio.cli.verbs import Verbs

_GIT_WAIT_S = 2.0


def add(verbs: Verbs) -> None:
    """Add `create` with the options of `ros2 pkg create`."""
    parser = verbs.add(
        "create",
        _create,
        "make a new package",
        "\nstudio pkg create --build-type ament_python --node-name talker my_package\n",
    )
    parser.add_argument("package_name", metavar="PACKAGE", nargs="?", help="its name")
    parser.add_argument(
        *("--package-format", "--package_format"),
        type=int,
        default=3,
        choices=(2, 3),
        help="of package.xml",
    )
    parser.add_argument("--description", default=NO_DESCRIPTION, help="what it is for")
    parser.add_argument(
        "--license",
        default=NO_LICENSE,
        help="any text; the file LICENSE is written for those that --license ? lists",
    )
    parser.add_argument(
        "--destination-directory",
        type=Path,
        default=Path(),
        metavar="DIR",
        help="where it is made; the current folder by default",
    )
    parser.add_argument(
        "--build-type", default="ament_cmake", choices=BUILD_TYPES, help="ament_cmake by default"
    )
    parser.add_argument(
        "--dependencies", nargs="+", default=[], metavar="NAME", help="packages that it needs"
    )
    parser.add_argument("--maintainer-email", default="", metavar="EMAIL")
    parser.add_argument("--maintainer-name", default="", metavar="NAME")
    parser.add_argument("--node-name", default="", metavar="NAME", help="an empty node to begin")
    parser.add_argument("--library-name", default="", metavar="NAME", help="an empty library")


def _create(options: argparse.Namespace) -> int:
    if options.license == "?":
        print("Supported licenses:", *LICENSES, sep="\n")
        print(f"Of {' and '.join(sorted(SHORT))} the notice is written, not the whole text.")
        return 0
    if not options.package_name:
        raise _nameless(options.dependencies)
    email = options.maintainer_email or _git_email() or f"{_user()}@todo.todo"
    new = NewPackage(
        name=options.package_name,
        build_type=options.build_type,
        dependencies=tuple(dict.fromkeys(options.dependencies)),
        node_name=options.node_name,
        library_name=options.library_name,
        license=options.license,
        description=options.description,
        maintainer_name=options.maintainer_name or _user(),
        maintainer_email=email,
        package_format=options.package_format,
    )
    folder = options.destination_directory.expanduser()
    made = create_package(folder, new)
    _print_wishes(new, Path(os.path.abspath(folder)))  # noqa: PTH100 - links are not followed
    target = folder / new.name
    print(f"creating folder {_dotted(target)}")
    for path in made:
        print(f"creating {_dotted(path)}")
    _print_license(new)
    return 0


def _nameless(dependencies: list[str]) -> SettingsError:
    """Return the sentence for a line without a name, which `--dependencies` may have taken."""
    taken = (
        f': "{dependencies[-1]}" was taken for a dependency, put the name before --dependencies'
        if dependencies
        else ""
    )
    return SettingsError(
        f"studio pkg create needs the name of the package{taken}: studio pkg create my_package "
        "--dependencies rclpy std_msgs."
    )


def _print_wishes(new: NewPackage, folder: Path) -> None:
    rows = {
        "package name": new.name,
        "destination directory": str(folder),
        "package format": str(new.package_format),
        "version": new.version,
        "description": new.description,
        "maintainer": f"['{new.maintainer_name} <{new.maintainer_email}>']",
        "licenses": str([known_license(new.license) or new.license]),
        "build type": new.build_type,
        "dependencies": str(list(new.dependencies)),
    }
    rows |= {"node_name": new.node_name} if new.node_name else {}
    rows |= {"library_name": new.library_name} if new.library_name else {}
    print("going to create a new package")
    for what, value in rows.items():
        print(harmless(f"{what}: {value}"))


def _print_license(new: NewPackage) -> None:
    spdx = known_license(new.license)
    if not spdx:
        print(
            f"\n[WARNING]: Unknown license '{harmless(new.license)}'. It stands in package.xml, "
            "and no LICENSE file was made.\nIt is recommended to use one of these:",
            *LICENSES,
            sep="\n",
        )
    elif spdx in SHORT:
        print(f"\n[WARNING]: LICENSE holds the notice of {spdx}: it says where its whole text is.")


def _dotted(path: Path) -> str:
    return harmless(str(path) if path.is_absolute() else f"./{path}")


def _user() -> str:
    import getpass

    try:
        return getpass.getuser()
    except (KeyError, OSError):  # a user without a name, in a container
        return "user"


def _git_email() -> str:
    """Return the address that git writes under commits; empty if there is none."""
    try:
        asked = subprocess.run(
            ["git", "config", "--get", "user.email"],
            capture_output=True,
            text=True,
            timeout=_GIT_WAIT_S,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return asked.stdout.strip()
