"""`studio check`: say what is wrong with robots; exit code 1: errors."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.serving import add_read_options, package_paths, read_mappings

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `check` to the parser."""
    parser.add_argument("path", metavar="PATH", type=Path, help="a file, a folder or a .zip")
    parser.add_argument("name:=value", nargs="*", help="arguments of the xacro file")
    parser.add_argument("--json", action="store_true", help="print a JSON list of the findings")
    parser.set_defaults(run=run, takes_mappings=True)
    add_read_options(parser)


def run(options: argparse.Namespace) -> int:
    """Check every robot at a path; 1 when one has errors."""
    import asyncio

    from studio.documents.check_run import check_path, exit_code, report_json, report_lines
    from studio.server.progress_bar import ProgressBar
    from studio.settings import Settings, data_folder

    arguments = read_mappings(options.mappings)
    settings = Settings(
        data_folder=data_folder(options.data_dir),
        package_paths=package_paths(options),
        trusted=options.trust,
    )
    bar = ProgressBar(sys.stderr)
    try:
        path = options.path.expanduser().absolute()
        files = asyncio.run(check_path(settings, path, arguments, bar.show))
    finally:
        bar.end()
    if options.json:
        print(report_json(files))
    else:
        print(*report_lines(files, Path.cwd()), sep="\n")
    return exit_code(files)
