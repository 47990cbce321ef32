"""One run of `studio`: finds the command, parses its arguments and runs it."""

from __future__ import annotations

import argparse
import errno
import os
import re
import sys
from typing import TYPE_CHECKING

import studio
from studio.cli.commands import add_command, summaries
from studio.cli.mending import MendingParser, instead_of, without_ros2
from studio.cli.terminal import harmless, take_any_letters
from studio.errors import StudioError

if TYPE_CHECKING:
    from collections.abc import Sequence


# `-1` alone is an option of `topic pub`; argparse itself knows it as a number elsewhere.
_VALUE = re.compile(r"-(?!1$)(\d|\.\d|\.?inf\b|\.?nan\b|$)", re.IGNORECASE)
_OUTPUT_ERRORS = {errno.EPIPE, errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO}
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
  studio demos talker listener             start two nodes of the course
  studio topic echo /chatter               see its messages: the lines of ros2, without ROS
"""


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command; return its exit code: 0 where it has none, 2 after a sentence on stderr."""
    arguments = without_ros2(sys.argv[1:] if argv is None else argv)
    if sentence := instead_of(arguments):
        print(f"studio: {sentence}", file=sys.stderr)
        return 2
    options = argparse.Namespace()
    take_any_letters()
    try:
        options = _read(arguments)
        code = options.run(options) or 0
        print(end="", flush=True)  # else what is wrong with the output is met after the end
    except StudioError as error:
        print(f"studio: {harmless(str(error))}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return getattr(options, "interrupted_code", 130)
    except OSError as error:
        return _output_refused(error)
    return code


def _output_refused(error: OSError) -> int:
    """End where nothing more can be printed; errors of any other kind are not expected."""
    if error.errno not in _OUTPUT_ERRORS:
        raise error
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    if error.errno == errno.EPIPE:  # the reader of our output has gone, as `head` does
        return 0
    print(f"studio: The output cannot be written: {error.strerror}.", file=sys.stderr)
    return 2


def _read(arguments: list[str]) -> argparse.Namespace:
    asked = next((argument for argument in arguments if not argument.startswith("-")), None)
    parser, command = _parsers(asked)
    mappings: list[str] = []
    if command is not None and command.get_default("takes_mappings"):
        end = arguments.index("--") if "--" in arguments else len(arguments)
        mappings = [argument for argument in arguments[:end] if ":=" in argument]
        arguments = [one for one in arguments[:end] if ":=" not in one] + arguments[end:]
    options, rest = parser.parse_known_args(shield_values(arguments))
    if rest[:1] == ["--"] or (len(rest) == 1 and not rest[0].startswith("-")):
        rest = _take_late(options, rest)
    if rest:
        parser.error(f"unrecognized arguments: {' '.join(rest)}")
    options.mappings = mappings
    return options


def _take_late(options: argparse.Namespace, rest: list[str]) -> list[str]:
    """Take the last value of a line, which argparse thinks left out when options stand before it.

    `takes_late` names the value, and what it is when it is left out.
    """
    name, left_out = getattr(options, "takes_late", ("", None))
    values = [argument for argument in rest if argument != "--"]
    if not name or getattr(options, name) != left_out or len(values) != 1:
        return rest
    setattr(options, name, values[0])
    return []


def shield_values(arguments: Sequence[str]) -> list[str]:
    """Put a blank before values that begin with a dash, which argparse then takes for values.

    YAML and Python's numbers skip the blank; arguments behind `--` are values already.
    """
    end = arguments.index("--") if "--" in arguments else len(arguments)
    shielded = [f" {one}" if _VALUE.match(one) else one for one in arguments[:end]]
    return [*shielded, *arguments[end:]]


def _parsers(
    asked: str | None,
) -> tuple[argparse.ArgumentParser, argparse.ArgumentParser | None]:
    """Make the parser of all commands; only that of the command that was asked for is filled in."""
    parser = MendingParser(
        prog="studio",
        description="See and tweak robot descriptions in the browser.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action="version", version=f"studio {studio.__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    own = {
        name: commands.add_parser(
            name, help=summary, formatter_class=argparse.RawDescriptionHelpFormatter
        )
        for name, summary in summaries().items()
    }
    command = own.get(asked or "")
    if asked is not None and command is not None:
        add_command(asked, command)
    return parser, command
