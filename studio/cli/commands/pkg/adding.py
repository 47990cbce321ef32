"""`studio pkg add`: a new node, message, service, action or launch file in a package."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.commands.pkg.inspect import what_is_known
from studio.cli.terminal import harmless
from studio.errors import SettingsError
from studio.packages.edits.new_files import LAUNCH_FORMATS, NODE_TEMPLATES

if TYPE_CHECKING:
    import argparse

    from studio.cli.verbs import Verbs
    from studio.packages.edits.package_edit import PackageEdit
    from studio.packages.sources.package_source import PackageSource

_WHAT = ("node", "msg", "srv", "action", "launch")


def add(verbs: Verbs) -> None:
    """Add the verb and its options."""
    parser = verbs.add(
        "add",
        _add,
        "add a node, interface or launch file to a package",
        "\nThe entries in setup.py, CMakeLists.txt and package.xml are written, too.\n"
        "\nstudio pkg add node talker --template publisher\n"
        "studio pkg add srv GetNowPlaying --package radio_station_interfaces\n",
    )
    parser.add_argument("what", metavar="WHAT", choices=_WHAT, help=", ".join(_WHAT))
    parser.add_argument("name", metavar="NAME", help="of the node, type or file")
    parser.add_argument(
        "--package",
        type=Path,
        default=Path(),
        metavar="DIR",
        help="its folder; this one by default",
    )
    parser.add_argument(
        "--template", choices=NODE_TEMPLATES, default="empty", help="what a new node does"
    )
    parser.add_argument(
        "--format", choices=LAUNCH_FORMATS, default="py", help="of a launch file; py by default"
    )
    parser.add_argument(
        "--node",
        action="append",
        default=[],
        nargs=2,
        metavar=("PACKAGE", "EXECUTABLE"),
        help="what a launch file starts; may be given again",
    )
    parser.add_argument("--text", type=Path, metavar="FILE", help="of an interface")


def _add(options: argparse.Namespace) -> int:
    from studio.packages.edits.writing import write_edit
    from studio.packages.roots import ServedRoots, package_folder_of
    from studio.packages.sources.package_source import PackageSource

    given = Path(os.path.realpath(options.package.expanduser()))
    folder = package_folder_of(given)
    if folder is None:
        raise SettingsError(f"{given} is in no package: name its folder by --package.")
    edit = _edit(options, PackageSource(folder))
    for path in write_edit(edit, ServedRoots([folder])).after:
        print(harmless(f"written: {os.path.relpath(path)}"))
    for sentence in edit.by_hand:
        print(harmless(sentence))
    return 1 if edit.by_hand else 0


def _edit(options: argparse.Namespace, source: PackageSource) -> PackageEdit:
    from studio.packages.edits.new_files import new_interface, new_launch_file, new_node

    if options.what == "node":
        return new_node(source, options.name, options.template, what_is_known())
    if options.what == "launch":
        nodes = [(package, name) for package, name in options.node]
        return new_launch_file(source, options.name, options.format, nodes)
    text = ""
    if options.text is not None:
        from studio.ros.types.files import read_text

        text = read_text(options.text)
    return new_interface(source, options.what, options.name, text, what_is_known())
