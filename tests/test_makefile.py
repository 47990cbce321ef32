"""The first two commands anybody types: what they say when they cannot, and how they end."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.support.patience import Stopwatch, ended_within

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

REPOSITORY = Path(__file__).resolve().parents[1]
END_WITHIN_S = 2.0

pytestmark = pytest.mark.skipif(not shutil.which("make"), reason="there is no make here")


# What a make around this test run would hand down: its flags and `ARGS=` would win over ours.
ENVIRONMENT = {
    name: value for name, value in os.environ.items() if "MAKE" not in name and name != "ARGS"
}


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """A folder with the Makefile and what its stamps depend on, and no environment yet."""
    for name in ("Makefile", "pyproject.toml", "constraints.txt"):
        shutil.copy(REPOSITORY / name, tmp_path / name)
    return tmp_path


def write_command(path: Path, script: str) -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


def complain(clone: Path, python: str | Path) -> str:
    """What `make demo PYTHON=...` says before it gives up; it must leave nothing behind."""
    answer = subprocess.run(
        ["make", "demo", f"PYTHON={python}"],
        cwd=clone,
        env=ENVIRONMENT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert answer.returncode != 0
    assert answer.stdout == ""
    assert not (clone / ".venv").exists()
    sentence, *rest = answer.stderr.splitlines()
    assert [line for line in rest if not line.startswith("make")] == []
    return sentence


def test_a_python_that_is_not_there_is_one_sentence(clone: Path):
    assert "no python9.9 here" in complain(clone, "python9.9")


def test_a_python_that_is_too_old_is_one_sentence(clone: Path):
    old = write_command(
        clone / "old", 'case "$*" in -V) echo Python 3.9.1;; *version_info*) exit 1;; esac'
    )
    sentence = complain(clone, old)
    assert "needs Python 3.11 or newer" in sentence
    assert "is Python 3.9.1" in sentence


def test_a_python_without_venv_is_one_sentence(clone: Path):
    bare = write_command(clone / "bare", 'case "$*" in *ensurepip*) exit 1;; esac')
    sentence = complain(clone, bare)
    assert "comes without venv" in sentence
    assert "apt install python3-venv" in sentence


def test_nothing_is_installed_again_until_the_requirements_change(clone: Path):
    log = clone / "log"
    install(clone, log)
    for _ in range(2):
        make(clone, "demo")
    assert calls(log) == ["pip", "demo", "demo"]
    later = time.time() + 5  # noqa: TID251 - file times are wall clock
    os.utime(clone / "constraints.txt", (later, later))
    make(clone, "demo")
    assert calls(log) == ["pip", "demo", "demo", "pip", "demo"]


def test_arguments_reach_the_command(clone: Path):
    log = clone / "log"
    install(clone, log)
    make(clone, "demo", "ARGS=--port 9000 --no-browser")
    assert log.read_text().splitlines()[-1] == "demo --port 9000 --no-browser"


def install(clone: Path, log: Path) -> None:
    """An environment whose pip and studio only write down how they were called."""
    commands = clone / ".venv" / "bin"
    write_command(commands / "python", f'case "$*" in *install*) echo pip >> "{log}";; esac')
    write_command(commands / "studio", f'echo "$@" >> "{log}"')
    (clone / ".venv" / ".made").touch()


def make(clone: Path, *arguments: str) -> None:
    subprocess.run(
        ["make", *arguments], cwd=clone, env=ENVIRONMENT, capture_output=True, check=True
    )


def calls(log: Path) -> list[str]:
    return [line.split()[0] for line in log.read_text().splitlines()]


@pytest.fixture
def demo(clone: Path) -> Iterator[subprocess.Popen[str]]:
    """`make demo` with the studio of this environment, in a process group of its own."""
    commands = clone / ".venv" / "bin"
    write_command(commands / "studio", f'exec "{sys.executable}" -m studio "$@"')
    for stamp in (".made", ".runs"):
        (clone / ".venv" / stamp).touch()
    with subprocess.Popen(
        ["make", "demo", "ARGS=--port 0 --no-browser"],
        cwd=clone,
        env={**ENVIRONMENT, "PYTHONPATH": str(REPOSITORY)},
        stdout=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        yield process
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            return


def interrupt_all(process: subprocess.Popen[str]) -> None:
    """Ctrl-C: the terminal tells the whole group."""
    os.killpg(process.pid, signal.SIGINT)


def terminate_make(process: subprocess.Popen[str]) -> None:
    """`kill` of the process that one started; make passes it on."""
    process.terminate()


@pytest.mark.skipif(not hasattr(os, "killpg"), reason="there are no process groups here")
@pytest.mark.parametrize("stop", [interrupt_all, terminate_make])
def test_the_demo_ends_with_all_of_its_processes(
    demo: subprocess.Popen[str], stop: Callable[[subprocess.Popen[str]], None]
):
    assert demo.stdout is not None
    assert demo.stdout.readline().startswith("Studio: http://127.0.0.1:")
    watch = Stopwatch()
    stop(demo)
    ended_within(demo, END_WITHIN_S, watch)
    while group_lives(demo.pid):
        assert watch.s < END_WITHIN_S, "a process of the studio stays"
        time.sleep(0.02)


def group_lives(group: int) -> bool:
    """Whether a process of the group still runs; one that only waits to be reaped does not."""
    if not Path("/proc/self/stat").exists():
        return _answers(group)
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _parent, its_group = stat.read_text().rpartition(")")[2].split()[:3]
        except OSError:
            continue
        if int(its_group) == group and state != "Z":
            return True
    return False


def _answers(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True
