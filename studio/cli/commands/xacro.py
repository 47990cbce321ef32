"""`studio xacro`: print the URDF, byte for byte as xacro does."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.serving import add_read_options, package_paths, read_mappings
from studio.errors import SettingsError

if TYPE_CHECKING:
    import argparse

    from studio.description.values import ReadPolicy


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of `xacro` to the parser."""
    parser.add_argument("file", metavar="FILE")
    parser.add_argument("name:=value", nargs="*", help="arguments of the xacro file")
    parser.add_argument("-o", dest="output", metavar="FILE", type=Path, help="write to FILE")
    parser.set_defaults(run=run, takes_mappings=True)
    add_read_options(parser)


def run(options: argparse.Namespace) -> None:
    """Expand one file as stock xacro does, within what may be read for it."""
    from studio.description.evaluator.stock_xacro import export_urdf
    from studio.settings import XACRO_MEMORY_BYTES
    from studio.system import limit_memory

    arguments = read_mappings(options.mappings)
    policy = _read_policy(options)
    limit_memory(XACRO_MEMORY_BYTES)  # a hostile file ends this process, not the machine
    _write(export_urdf(options.file, arguments, policy).encode(), options.output)


def _read_policy(options: argparse.Namespace) -> ReadPolicy:
    """Return what `studio xacro` may read for its file: what `studio open` would serve for it."""
    from studio.description.values import ReadPolicy
    from studio.packages.workspace import open_location
    from studio.settings import XACRO_ENVIRONMENT, data_folder

    path = Path(options.file).absolute()
    folder = data_folder(options.data_dir)
    location = open_location(path, package_paths(options), folder, os.environ)
    shown = {
        name: value
        for name, value in os.environ.items()
        if options.trust or name in XACRO_ENVIRONMENT
    }
    return ReadPolicy(
        roots=tuple(map(str, location.served.all)),
        packages=location.index.mapping_for(path),
        environment=shown,
        trusted=options.trust,
    )


def _write(content: bytes, output: Path | None) -> None:
    """Write to stdout, or to a file whose folder is made, as xacro does."""
    if output is None:
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_bytes(content)
    except OSError as error:
        raise SettingsError(f"{output} cannot be written: {error.strerror}.") from error
