"""The same small programs under `studio run` and under the real rclpy: both do the same."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.support.rclpy_scripts import SCRIPTS, script_of
from tests.support.ros2_peer import real_program
from tests.support.student_programs import environment_at, studio_run
from tests.support.sweep import some_of

_LOG = re.compile(
    r"\[(?:DEBUG|INFO|WARN|ERROR|FATAL)\] \[\d+\.\d+\] \[(?P<name>[^\]]*)\]: (?P<text>.*)"
)
_ZENOH = re.compile(r"^\x1b\[2m.*$\n?", re.MULTILINE)
_RUNS_S = 5.0
_RAISED = re.compile(r"^([A-Za-z_][\w.]*)(?::|$)", re.MULTILINE)


@dataclass(frozen=True)
class Seen:
    """What a program does, less what depends on time."""

    code: int
    out: str
    logs: list[str]
    raised: str


def seen(ran: subprocess.CompletedProcess[str]) -> Seen:
    err = ran.stderr
    logs = [
        # What an action server says of a mistake is in words of its own.
        found["name"]
        if found["name"].endswith("action_server")
        else found[0].split("] ", 1)[0] + found["name"] + found["text"]
        for found in _LOG.finditer(err)
        if found["name"] != "rcl"
    ]
    after = err.rpartition("Traceback (most recent call last):\n")[2] if "Traceback" in err else ""
    names = _RAISED.findall(after)
    return Seen(ran.returncode, _ZENOH.sub("", ran.stdout), logs, names[0] if names else "")


@pytest.mark.network
@pytest.mark.parametrize("about", some_of(SCRIPTS, every=4))
def test_a_program_does_under_studio_run_what_it_does_under_rclpy(
    about: str, endpoint: str, tmp_path: Path
):
    file = tmp_path / "program.py"
    file.write_text(script_of(about))
    assert seen(studio_run(endpoint, str(file))) == seen(real_program(endpoint, file))


@pytest.mark.network
@pytest.mark.skipif("STUDIO_ROS2_EXAMPLES" not in os.environ, reason="STUDIO_ROS2_EXAMPLES names "
                    "no folder of the public ros2/examples")  # fmt: skip
def test_the_public_examples_start(endpoint: str):
    folder = Path(os.environ["STUDIO_ROS2_EXAMPLES"])
    files = sorted(one for one in folder.rglob("*.py") if "rclpy" in one.read_text()
                   and "__main__" in one.read_text())  # fmt: skip
    assert files
    failed: list[str] = []
    for file in files:
        words = [sys.executable, "-P", "-m", "studio", "run", str(file)]
        process = subprocess.Popen(words, env=environment_at(endpoint), stderr=subprocess.PIPE,
                                   stdout=subprocess.DEVNULL, text=True)  # fmt: skip
        try:
            _, err = process.communicate(timeout=_RUNS_S)
        except subprocess.TimeoutExpired:
            process.kill()  # a server, or a client that waits for one
            _, err = process.communicate()
        if "Traceback" in err:
            failed.append(f"{file.name}: {err.splitlines()[-1]}")
    assert failed == []
