from __future__ import annotations

import os
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from studio.course.leashed import read_lines
from tests.support.patience import ended_within
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from pathlib import Path

_WAITING = """
import signal, sys
print("ready", *sys.argv[1:], flush=True)
signal.pause()
"""
_PRESSED = """
from studio.course.turtlesim.keyboard import key_presses
with key_presses() as next_key:
    print(next_key(), next_key(), flush=True)
"""


def leashed(folder: Path, text: str, *words: str) -> subprocess.Popen[str]:
    (folder / "held.py").write_text(text)
    return subprocess.Popen(
        [sys.executable, "-m", "studio.course.leashed", "held", *words],
        env={**os.environ, "PYTHONPATH": str(folder)},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def test_it_ends_once_nobody_holds_its_input_any_more(tmp_path: Path):
    with leashed(tmp_path, _WAITING, "41", "1") as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stdout.readline() == "ready 41 1\n"
        process.stdin.close()
        assert ended_within(process, PATIENCE_S) == -signal.SIGTERM


def test_lines_of_its_input_are_keys(tmp_path: Path):
    with leashed(tmp_path, _PRESSED) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write("up\ng\n")
        process.stdin.flush()
        assert process.stdout.readline() == "up g\n"
        assert ended_within(process, PATIENCE_S) == 0


@pytest.mark.parametrize(
    ("sent", "taken"),
    [
        (b"up\nleft\n", ["up", "left"]),
        (b"no end", []),
        (b"x" * 5000 + b"\nup\n", ["x" * 64, "up"]),
        (b"\xff\n", ["\ufffd"]),
    ],
)
def test_lines_are_taken_whole_and_none_is_long(sent: bytes, taken: list[str]):
    reading, writing = os.pipe()
    try:
        os.write(writing, sent)
        os.close(writing)
        found: list[str] = []
        read_lines(reading, found.append)
        assert found == taken
    finally:
        os.close(reading)
