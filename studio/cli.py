"""The `studio` command. Rooms are imported inside the commands: each pays only for its own."""

from __future__ import annotations

import argparse
import gc
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import studio
from studio.errors import SettingsError, StudioError, UnreadableFileError
from studio.settings import DEFAULT_HOST, DEFAULT_PORT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from studio.description.values import ReadPolicy
    from studio.settings import Settings

_EXAMPLES = """\
examples:
  studio demo                              look at the sample rover, drag its properties
  studio open                              open what was opened last
  studio open robot.urdf.xacro             open a file
  studio open ~/ws/src                     open a workspace, a package folder or a .zip
  studio open ur.urdf.xacro ur_type:=ur10e name:=ur
                                           pass arguments as to xacro
  studio check ~/ws/src                    say what is wrong with every robot there
  studio xacro robot.urdf.xacro > robot.urdf
                                           expand as the xacro command does
"""
_MAPPING = ":="
_DEMO_PACKAGE = "rover_description"
_HIGHEST_PORT = 65535


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; answers its exit code: 0 where it has none, 2 after a sentence on stderr."""
    given = sys.argv[1:] if argv is None else list(argv)
    mappings = [word for word in given if _MAPPING in word]
    options = _parser().parse_args([word for word in given if _MAPPING not in word])
    try:
        return options.run(options, _arguments(mappings)) or 0
    except StudioError as error:
        print(f"studio: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:  # the reader of our output has gone, as `head` does
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="studio",
        description="See and tweak robot descriptions in the browser.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"studio {studio.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    demo = commands.add_parser("demo", help="open a working copy of the sample rover")
    demo.add_argument(
        "--fresh", action="store_true", help="renew the working copy; its changes are lost"
    )
    demo.set_defaults(run=_demo)
    _add_server_options(demo)
    opens = commands.add_parser("open", help="open a .xacro or .urdf file, a folder or a .zip")
    opens.add_argument("path", metavar="PATH", type=Path, nargs="?", help="default: the last one")
    opens.add_argument("name:=value", nargs="*", help="arguments of the xacro file")
    opens.set_defaults(run=_open)
    _add_server_options(opens)
    check = commands.add_parser("check", help="say what is wrong with robots; exit code 1: errors")
    check.add_argument("path", metavar="PATH", type=Path, help="a file, a folder or a .zip")
    check.add_argument("name:=value", nargs="*", help="arguments of the xacro file")
    check.add_argument("--json", action="store_true", help="print a JSON list of the findings")
    check.set_defaults(run=_check)
    _add_read_options(check)
    expand = commands.add_parser("xacro", help="print the URDF, byte for byte as xacro does")
    expand.add_argument("file", metavar="FILE")
    expand.add_argument("name:=value", nargs="*", help="arguments of the xacro file")
    expand.add_argument("-o", dest="output", metavar="FILE", type=Path, help="write to FILE")
    expand.set_defaults(run=_xacro)
    _add_read_options(expand)
    return parser


def _add_server_options(parser: argparse.ArgumentParser) -> None:
    """Options of every command that starts the server."""
    parser.add_argument(
        "--host", default=DEFAULT_HOST, help="address to listen on (default: this machine only)"
    )
    parser.add_argument(
        "--port", type=_port, help=f"port to listen on (default: {DEFAULT_PORT} or the next free)"
    )
    parser.add_argument("--no-browser", action="store_true", help="open no browser window")
    parser.add_argument(
        "--no-token", action="store_true", help="ask nobody for the token; this machine only"
    )
    parser.add_argument(
        "--viewer-link", action="store_true", help="print an address for those who only look, too"
    )
    _add_read_options(parser)


def _add_read_options(parser: argparse.ArgumentParser) -> None:
    """Options of every command that reads robot descriptions."""
    parser.add_argument(
        "--package-path",
        action="append",
        default=[],
        metavar="DIR",
        help="also find packages here, read-only; may be given again",
    )
    parser.add_argument(
        "--data-dir", type=Path, metavar="DIR", help="where working copies and caches live"
    )
    parser.add_argument(
        "--trust",
        action="store_true",
        help="for your own files, on this machine only: $(env) sees every environment variable, "
        "not only those of ROS; expressions and what may be read stay as they are",
    )


def _port(text: str) -> int:
    number = int(text)
    if not 0 <= number <= _HIGHEST_PORT:
        raise argparse.ArgumentTypeError(f"{number} is no port: 0 to {_HIGHEST_PORT}")
    return number


def _arguments(words: Sequence[str]) -> dict[str, str]:
    """`name:=value` by name, as xacro reads it: outer blanks dropped, `_name` is not for it.

    Raises:
        SettingsError: A word has more than one `:=`.
    """
    found: dict[str, str] = {}
    for word in words:
        name, *values = (part.strip() for part in word.split(_MAPPING))
        if len(values) != 1:
            raise SettingsError(f"{word} is no argument: write it as name:=value.")
        is_hidden = len(name) > 1 and name[0] == "_" and name[1] != "_"
        if name and values[0] and not is_hidden:
            found[name] = values[0]
    return found


def _package_paths(options: argparse.Namespace) -> tuple[Path, ...]:
    """All `--package-path`, each of which may hold several, as PATH does."""
    parts = (part for given in options.package_path for part in given.split(os.pathsep))
    return tuple(Path(part).expanduser() for part in parts if part)


def _demo(options: argparse.Namespace, arguments: dict[str, str]) -> None:
    from studio.engine.keeping.draft_store import forget_drafts
    from studio.packages.working_copy import working_copy
    from studio.settings import repository_or_wheel

    settings = _settings(options)
    models = repository_or_wheel("models")
    package = working_copy(models, settings.data_folder, _DEMO_PACKAGE, fresh=options.fresh)
    if options.fresh:
        from studio.engine.keeping.draft_store import forget_drafts

        forget_drafts(settings.data_folder, package.rglob("*"))
    _launch(options, settings, package, arguments)


def _open(options: argparse.Namespace, arguments: dict[str, str]) -> None:
    if options.path is None:
        _open_last(options, arguments)
        return
    path = options.path.expanduser()
    if not path.exists():
        raise UnreadableFileError(str(path), "there is no such file or folder.")
    _launch(options, _settings(options), path.absolute(), arguments)


def _open_last(options: argparse.Namespace, arguments: dict[str, str]) -> None:
    """Open what was opened last; the sample rover while that was nothing."""
    from studio.packages.recent import last_opened

    settings = _settings(options)
    last = last_opened(settings.data_folder)
    if last is None:
        options.fresh = False
        _demo(options, arguments)
        return
    _launch(options, settings, Path(last.path), arguments or last.arguments)


def _launch(
    options: argparse.Namespace, settings: Settings, path: Path, arguments: dict[str, str]
) -> None:
    gc.disable()  # all that is imported lives on: looking through it meanwhile costs a third
    from studio.web.launch import Opening, launch

    gc.freeze()
    gc.enable()
    launch(settings, Opening(path, arguments), viewer_link=options.viewer_link)


def _settings(options: argparse.Namespace) -> Settings:
    from studio.settings import Settings, data_folder
    from studio.web.credentials import new_token

    return Settings(
        host=options.host,
        port=options.port,
        token=None if options.no_token else new_token(),
        data_folder=data_folder(options.data_dir),
        package_paths=_package_paths(options),
        trusted=options.trust,
        open_browser=not options.no_browser,
    )


def _check(options: argparse.Namespace, arguments: dict[str, str]) -> int:
    import asyncio

    from studio.engine.check_run import check_path
    from studio.engine.checks.check_report import exit_code, report_json, report_lines
    from studio.settings import Settings, data_folder
    from studio.web.progress_bar import ProgressBar

    settings = Settings(
        data_folder=data_folder(options.data_dir),
        package_paths=_package_paths(options),
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


def _xacro(options: argparse.Namespace, arguments: dict[str, str]) -> None:
    from studio.description.evaluator.oracle import export_urdf
    from studio.settings import XACRO_MEMORY_BYTES
    from studio.system import limit_memory

    policy = _read_policy(options)
    limit_memory(XACRO_MEMORY_BYTES)  # a hostile file ends this process, not the machine
    _write(export_urdf(options.file, arguments, policy).encode(), options.output)


def _read_policy(options: argparse.Namespace) -> ReadPolicy:
    """What `studio xacro` may read for its file: what `studio open` would serve for it."""
    from studio.description.values import ReadPolicy
    from studio.packages.workspace import open_location
    from studio.settings import XACRO_ENVIRONMENT, data_folder

    path = Path(options.file).absolute()
    folder = data_folder(options.data_dir)
    location = open_location(path, _package_paths(options), folder, os.environ)
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
    """To stdout, or to a file whose folder is made, as xacro does."""
    if output is None:
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_bytes(content)
    except OSError as error:
        raise SettingsError(f"{output} cannot be written: {error.strerror}.") from error
