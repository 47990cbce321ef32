"""Runs a user's Python program as `ros2 run` and `python3` do, with ROS's modules importable."""

from __future__ import annotations

import importlib
import importlib.util
import os
import re
import runpy
import signal
import sys
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from studio.errors import (
    NoRouterError,
    NotAdmittedError,
    RouterNotStartedError,
    WireSettingsError,
)
from studio.importable.finder import install, missing_sentence
from studio.importable.hints import watch as hints
from studio.importable.hints.said import ROOM
from studio.importable.names import MODULES
from studio.importable.rclpy_parts.exceptions import name_as_rclpy
from studio.importable.workspace import Workspace
from studio.ros import strictness
from studio.ros.names import KINDS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import TracebackType

STRICT: Final = "--strict"
_FAILED: Final = 1
_NOT_THERE: Final = re.compile(r"cannot import name '(?P<name>\w+)' from '(?P<module>[\w.]+)'")
"""Python leaves out what a module says of a name that it does not have."""


def main(arguments: Sequence[str]) -> int:
    """Run what the words of a `Program` name; its own arguments follow them."""
    words = list(arguments)
    strict = words[:1] == [STRICT]
    if strict:
        words = words[1:]
    count = 4 if words[:1] == ["entry"] else 2
    return run_words(words[:count], words[count:], strict=strict)


def run_words(words: Sequence[str], arguments: Sequence[str], *, strict: bool = False) -> int:
    """Run a program; return its exit code.

    Args:
        words: `entry ROOT MODULE:FUNCTION NAME`, or `file PATH`.
        arguments: Those of the program, which it finds in `sys.argv`.
        strict: Whether what would fail in ROS 2 is an error, and no warning.
    """
    prepare(strict=strict)
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        # So a script starts what it puts into the background; ROS's nodes are ended by it, too.
        signal.signal(signal.SIGINT, signal.default_int_handler)
    match list(words):
        case ["entry", root, place, name]:
            sys.argv = [name, *arguments]
            return _watched(lambda: _run_entry(root, place))
        case ["file", path]:
            sys.argv = [path, *arguments]
            return _watched(lambda: _run_file(path), file=path)
        case _:
            print("usage: entry ROOT MODULE:FUNCTION NAME | file PATH", file=sys.stderr)  # noqa: T201
            return 2


def prepare(*, strict: bool = False) -> None:
    """Make ROS's modules importable in this process, unless a real rclpy is."""
    real = importlib.util.find_spec("rclpy")
    if real is not None:
        where = Path(real.origin).parent if real.origin else "rclpy"
        print(f"studio: the rclpy of {where} is used, not the studio's.", file=sys.stderr)  # noqa: T201
        return
    strictness.begin(strict=strict)
    name_as_rclpy()
    install(Workspace())


def _run_entry(root: str, place: str) -> object:
    """Call the function of an entry point, as the script does that setuptools writes."""
    module, _, function = place.partition(":")
    sys.path[:0] = [os.path.dirname(sys.argv[0]), root]  # noqa: PTH120 - as Python's own first
    target: Any = importlib.import_module(module)
    for name in function.split("."):
        target = getattr(target, name)
    return target()


def _run_file(path: str) -> object:
    sys.path.insert(0, os.path.dirname(os.path.realpath(path)))  # noqa: PTH120
    runpy.run_path(path, run_name="__main__")
    return None


def _watched(run: Callable[[], object], file: str | None = None) -> int:
    """Run, and say what a beginner should know about it; return the exit code."""
    watch = hints.begin()
    code, error = _ended(run)
    if watch is not None:
        watch.end(error, file)
    return code


def _ended(run: Callable[[], object]) -> tuple[int, BaseException | None]:
    """Run; return the exit code, and what was not caught, printed as Python prints it."""
    try:
        return _code_of(run()), None
    except SystemExit as error:
        return _code_of(error.code), error
    except (NoRouterError, RouterNotStartedError, WireSettingsError, NotAdmittedError) as error:
        print(f"studio: {error}", file=sys.stderr)  # noqa: T201
        return 2, error
    except BaseException as error:  # noqa: BLE001 - printed, as at the end of any program
        print_failure(error)
        return 130 if isinstance(error, KeyboardInterrupt) else _FAILED, error


def _code_of(code: object) -> int:
    """Return the exit code of what `sys.exit` was given: a text is printed, as Python does."""
    if code is None:
        return 0
    if isinstance(code, int):
        return code
    print(code, file=sys.stderr)  # noqa: T201
    return _FAILED


def print_failure(error: BaseException) -> None:
    """Print a traceback from the first frame of the user's own code on."""
    found = _NOT_THERE.match(str(error)) if isinstance(error, ImportError) else None
    if found is not None:
        _tell_of_missing(error, found["module"], found["name"])
    sys.stdout.flush()
    traceback.print_exception(type(error), error, _users_part(error))


def _tell_of_missing(error: BaseException, module: str, name: str) -> None:
    """Note on an error what the module says of a name that it does not have."""
    if module in MODULES:
        error.add_note(missing_sentence(f"{module}.{name}"))
        return
    say: Any = getattr(sys.modules.get(module), "__getattr__", None)
    if module.rpartition(".")[2] in KINDS and say is not None:
        try:
            say(name)
        except AttributeError as reason:
            error.add_note(str(reason))


def _users_part(error: BaseException) -> TracebackType | None:
    """Return the traceback without the frames that led to the user's code; all where none is.

    A file that is no Python has no frame: its error alone names the line, as Python prints it.
    """
    first = error.__traceback__
    while first is not None and _is_ours(first):
        first = first.tb_next
    if first is None and not isinstance(error, SyntaxError):
        return error.__traceback__
    return first


def _is_ours(tb: TracebackType) -> bool:
    name = tb.tb_frame.f_code.co_filename
    return name.startswith((ROOM, "<frozen ")) or name in {runpy.__file__, importlib.__file__}
