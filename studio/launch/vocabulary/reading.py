"""Reads a launch file into what it describes; its faults become sentences with their lines."""

from __future__ import annotations

import ast
import os
import sys
from itertools import count
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

from studio.errors import LaunchFileError, StudioError
from studio.launch.vocabulary.actions import LaunchDescription
from studio.launch.vocabulary.places import unplaced, where_raised
from studio.launch.vocabulary.texts import perform

if TYPE_CHECKING:
    from studio.launch.vocabulary.context import LaunchContext
    from studio.launch.vocabulary.sources import LaunchDescriptionSource

SIZE_LIMIT_BYTES: Final = 2 << 20
_NUMBERS = count(1)


def kind_of(path: str) -> str:
    """Return the kind of a launch file by its name: `python`, `xml`, `yaml`, or empty."""
    lower = path.lower()
    if lower.endswith(".py"):
        return "python"
    if lower.endswith((".xml", ".launch")):
        return "xml"
    return "yaml" if lower.endswith((".yaml", ".yml")) else ""


def description_of(source: LaunchDescriptionSource, context: LaunchContext) -> LaunchDescription:
    """Return what a source describes.

    Raises:
        LaunchFileError: It cannot be read, or is no launch file.
    """
    if source.launch_description is not None:
        return source.launch_description
    path = os.path.abspath(perform(context, source.location))  # noqa: PTH100 - links stay
    return read_launch_file(path, source.kind, source.method)


def read_launch_file(path: str, kind: str = "", method: str = "") -> LaunchDescription:
    """Read a launch file of a kind; empty or `frontend`: as its name, or else its text says.

    Raises:
        LaunchFileError: It cannot be read, or is no launch file.
    """
    data = _read(path)
    named = kind_of(path)
    actual = kind if kind in ("python", "xml", "yaml") else named or _guessed(data)
    if kind == "python" and named and named != "python":
        reason = "PythonLaunchDescriptionSource reads Python: write AnyLaunchDescriptionSource"
        raise LaunchFileError(path, 0, reason)
    if actual == "python":
        return _read_python(path, data, method or "generate_launch_description")
    from studio.launch.frontends.elements import description_of_root  # noqa: PLC0415
    from studio.launch.frontends.reading import read_xml, read_yaml  # noqa: PLC0415

    return description_of_root((read_xml if actual == "xml" else read_yaml)(path, data))


def _guessed(data: bytes) -> str:
    return "xml" if data.lstrip().startswith(b"<") else "yaml"


def _read(path: str) -> bytes:
    try:
        if not Path(path).is_file():
            raise LaunchFileError(path, 0, _not_there(path))
        with Path(path).open("rb") as file:
            data = file.read(SIZE_LIMIT_BYTES + 1)
    except (OSError, ValueError) as error:
        raise LaunchFileError(path, 0, f"it cannot be read ({error})") from None
    if len(data) > SIZE_LIMIT_BYTES:
        raise LaunchFileError(path, 0, f"it is larger than {SIZE_LIMIT_BYTES >> 20} MB")
    return data


def _not_there(path: str) -> str:
    folder = Path(path).parent
    if Path(path).exists():
        return "it is no regular file"
    if not folder.is_dir():
        return f"there is no such launch file: {folder} is not there"
    names = sorted(one.name for one in folder.iterdir() if "launch" in one.name)[:8]
    return "there is no such launch file" + (
        f": the folder has {', '.join(names)}" if names else ""
    )


def _read_python(path: str, data: bytes, method: str) -> LaunchDescription:
    module = ModuleType(f"launch_file_{next(_NUMBERS)}")
    module.__file__ = path
    try:
        code = compile(data, path, "exec", dont_inherit=True)
    except SyntaxError as error:
        raise LaunchFileError(path, error.lineno or 0, _syntax(error)) from None
    except (ValueError, RecursionError, MemoryError) as error:
        raise LaunchFileError(path, 0, f"it is no Python ({error})") from None
    sys.modules[module.__name__] = module  # for what looks a class's module up
    with unplaced():
        try:
            exec(code, module.__dict__)
        except BaseException as error:
            raise fault_of(error, path, data) from error
        function = getattr(module, method, None)
        if not callable(function):
            raise LaunchFileError(path, 0, _no_function(method, data))
        try:
            made = function()
        except BaseException as error:
            raise fault_of(error, path, data) from error
    return _checked(made, path, method, data)


def _syntax(error: SyntaxError) -> str:
    return f"it is no Python ({error.msg}): mend this line, or the one before it"


def _no_function(method: str, data: bytes) -> str:
    if b"rclpy" in data and b"launch" not in data:
        return "this is a node, not a launch file: start it with studio run"
    return (
        f"it has no function {method}(): write one, at the beginning of a line, that returns a "
        "LaunchDescription"
    )


def _checked(made: Any, path: str, method: str, data: bytes) -> LaunchDescription:
    if isinstance(made, LaunchDescription):
        return made
    line = _line_of_function(data, method)
    if made is None:
        reason = f"{method}() returns nothing: end it with return LaunchDescription([...])"
    else:
        reason = f"{method}() returns {type(made).__name__}: it must return a LaunchDescription"
    raise LaunchFileError(path, line, reason)


def _line_of_function(data: bytes, name: str) -> int:
    for node in ast.walk(ast.parse(data)):
        if isinstance(node, ast.FunctionDef) and node.name == name:
            return node.end_lineno or node.lineno
    return 0


def fault_of(error: BaseException, path: str, data: bytes = b"") -> BaseException:
    """Return what an exception of a launch file's code is, with its line and a mend.

    What ends the process as a whole is given back as it is.
    """
    if isinstance(error, KeyboardInterrupt | LaunchFileError | GeneratorExit):
        return error
    where = where_raised(error.__traceback__, path)
    return LaunchFileError(where.file or path, where.line, sentence_of(error, data, where.line))


def sentence_of(error: BaseException, data: bytes = b"", line: int = 0) -> str:
    """Return an exception as half a sentence, with the mend where it is known."""
    if isinstance(error, StudioError):
        text = str(error)
        return text if text.endswith("...") else text.removesuffix(".")
    if isinstance(error, SystemExit):
        return f"it ends the process by itself (exit code {error.code}): leave that out"
    if isinstance(error, NameError) and error.name:
        return _name_error(error.name, data, line)
    if isinstance(error, RecursionError):
        return "it calls itself without end"
    if isinstance(error, MemoryError):
        return "it needs more memory than planning may take"
    text = " ".join(str(error).split())[:500]
    if isinstance(error, KeyError) and text.startswith("package '"):
        found = text.partition(",")[0]
        return f"{found}: open the workspace that holds it, or give --package-path"
    if isinstance(error, KeyError):
        return f"there is no {text}: set it, or ask with a default (KeyError)"
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def _name_error(name: str, data: bytes, line: int) -> str:
    from studio.launch.modules import module_of  # noqa: PLC0415

    imported = _import_line(data, name)
    if imported > line > 0:
        return (
            f"{name} is used before it is imported, in line {imported}: move that line to the top"
        )
    module = module_of(name)
    if module is not None:
        return f"{name} is not known here: add from {module} import {name} at the top"
    return f"{name} is not known here: define or import it before it is used"


def _import_line(data: bytes, name: str) -> int:
    try:
        tree = ast.parse(data)
    except (SyntaxError, ValueError):
        return 0
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom) and any(
            (one.asname or one.name) == name for one in node.names
        ):
            return node.lineno
    return 0
