from __future__ import annotations

import threading
from pathlib import Path

import pytest

from studio.errors import SubstitutionFailure
from studio.launch.command_output import CommandOutput
from studio.packages.index import PackageIndex


def _commands() -> CommandOutput:
    return CommandOutput(PackageIndex([]), Path("a.launch.py"))


def test_what_a_command_prints_is_its_text_and_stderr_beside_it():
    assert _commands().of("sh -c 'echo out; echo err >&2'") == ("out\n", "err")


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("yes", "'yes' prints more than 16 MB: it was ended"),
        ("sh -c 'echo why >&2; exit 3'", r"\(exit code 3\): why"),
        ("no_such_program_here", "was not run"),
        ("", "a command is empty"),
        ("'", "is none"),
    ],
)
def test_a_command_that_gives_no_text_is_a_sentence(line: str, sentence: str):
    with pytest.raises(SubstitutionFailure, match=sentence):
        _commands().of(line)


def test_a_child_that_holds_the_pipe_does_not_hold_the_launch():
    assert _commands().of("sh -c 'sleep 1000 & echo done'")[0] == "done\n"


def test_a_command_is_ended_from_another_thread():
    commands = _commands()
    timer = threading.Timer(0.3, commands.end)
    timer.start()
    with pytest.raises(SubstitutionFailure, match="was ended with the launch"):
        commands.of("sleep 1000")
    timer.join()
