from __future__ import annotations

import asyncio
import os
import signal
import sys
from typing import TYPE_CHECKING

import pytest

from studio.importable import running
from studio.launch.prepared import ForkedProcess, Prepared
from studio.launch.watchdog import take_up_orphans
from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping
    from pathlib import Path

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="Linux alone has what it needs")

_TELLS = """\
import atexit, json, os, random, signal, sys, threading
import numpy
atexit.register(print, 'at exit')
print(json.dumps({
    'argv': sys.argv, 'original': sys.orig_argv, 'path': sys.path,
    'environment': dict(os.environ), 'cwd': os.getcwd(),
    'files': sorted(int(one) for one in os.listdir('/proc/self/fd')[:-1]),
    'command': open('/proc/self/cmdline').read().rstrip(chr(0)).split(chr(0)),
    'parent': os.getppid(), 'session': os.getsid(0) == os.getpid(),
    'threads': [one.name for one in threading.enumerate()],
    'signals': [str(signal.getsignal(one)) for one in (signal.SIGINT, signal.SIGTERM)],
    'blocked': sorted(signal.pthread_sigmask(signal.SIG_BLOCK, [])),
    'main': sys.modules['__main__'].__name__, 'flags': str(sys.flags),
}))
print(random.random(), numpy.random.random(), file=sys.stderr)
"""
_ENDS = """\
import os, signal, sys, time
how = sys.argv[1]
if how == 'code': sys.exit(7)
if how == 'crash': raise RuntimeError('as written')
if how == 'killed': os.kill(os.getpid(), signal.SIGKILL)
if how == 'abort': os.abort()
print('waits', flush=True)
time.sleep(600)
"""


@pytest.fixture(scope="module", autouse=True)
def _orphans() -> Generator[None]:  # pyright: ignore[reportUnusedFunction]
    yield
    take_up_orphans(does=False)  # those of later tests are nothing to this process


@pytest.fixture(scope="module")
def prepared() -> Generator[Prepared]:
    with Prepared(os.environ) as one:
        yield one


def _command(file: Path, *words: str) -> list[str]:
    return [sys.executable, "-P", "-m", running.__package__ or "", "file", str(file), *words]


async def _ran(process: ForkedProcess | asyncio.subprocess.Process) -> tuple[int, str, str]:
    assert process.stdout is not None
    assert process.stderr is not None
    async with asyncio.timeout(PATIENCE_S):
        out, err = await asyncio.gather(process.stdout.read(), process.stderr.read())
        return await process.wait(), out.decode(), err.decode()


async def _forked(
    prepared: Prepared, command: list[str], environment: Mapping[str, str], cwd: str | None = None
) -> ForkedProcess:
    process = await prepared.start(command, environment, cwd)
    assert process is not None
    return process


async def _as_any(
    command: list[str], environment: Mapping[str, str], cwd: Path
) -> asyncio.subprocess.Process:
    return await asyncio.create_subprocess_exec(
        *command,
        stdin=asyncio.subprocess.DEVNULL,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        env=environment,
        cwd=cwd,
        start_new_session=True,
    )


def test_a_forked_node_finds_what_one_of_a_process_of_its_own_finds(
    prepared: Prepared, tmp_path: Path
):
    file = tmp_path / "tells.py"
    file.write_text(_TELLS)
    command = _command(file, "a b", "--ros-args")
    environment = {**os.environ, "MINE": "1"}

    async def both() -> list[tuple[int, str, str]]:
        first = await _forked(prepared, command, environment, str(tmp_path))
        second = await _forked(prepared, command, environment, str(tmp_path))
        own = await _as_any(command, environment, tmp_path)
        return [await _ran(one) for one in (first, second, own)]

    first, second, own = asyncio.run(both())
    assert first[:2] == own[:2]
    assert first[0] == 0
    assert len({one[2] for one in (first, second, own)}) == 3, "random numbers come again"
    assert '"files": [0, 1, 2]' in first[1]
    assert f'"parent": {os.getpid()}' in first[1]


@pytest.mark.parametrize(
    ("how", "code"), [("code", 7), ("crash", 1), ("killed", -9), ("abort", -6)]
)
def test_its_end_is_told_as_that_of_any_process(
    prepared: Prepared, tmp_path: Path, how: str, code: int
):
    file = tmp_path / "ends.py"
    file.write_text(_ENDS)

    async def end() -> tuple[int, str, str]:
        return await _ran(await _forked(prepared, _command(file, how), os.environ))

    ended, _, errors = asyncio.run(end())
    assert ended == code
    assert ("RuntimeError: as written" in errors) == (how == "crash")
    assert "prepared.py" not in errors


@pytest.mark.parametrize(
    ("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, -15), (signal.SIGKILL, -9)]
)
def test_signals_to_its_group_reach_it(prepared: Prepared, tmp_path: Path, number: int, code: int):
    file = tmp_path / "ends.py"
    file.write_text(_ENDS)

    async def end() -> int:
        process = await _forked(prepared, _command(file, "waits"), os.environ)
        async with asyncio.timeout(PATIENCE_S):
            assert await process.stdout.readline() == b"waits\n"
            os.killpg(process.pid, number)
            return await process.wait()

    assert asyncio.run(end()) == code


def test_what_it_cannot_make_is_left_to_who_asked(prepared: Prepared, tmp_path: Path):
    file = tmp_path / "ends.py"
    file.write_text(_ENDS)
    command = _command(file, "code")

    async def ask() -> list[ForkedProcess | None]:
        return [
            await prepared.start(["sleep", "1"], os.environ, None),
            await prepared.start(command, {**os.environ, "PYTHONHASHSEED": "1"}, None),
            await prepared.start(command, os.environ, str(tmp_path / "missing")),
        ]

    assert asyncio.run(ask()) == [None, None, None]


def test_a_prepared_process_that_was_killed_leaves_its_nodes_and_makes_no_more(tmp_path: Path):
    file = tmp_path / "ends.py"
    file.write_text(_ENDS)

    async def kill(prepared: Prepared) -> tuple[ForkedProcess | None, int]:
        process = await _forked(prepared, _command(file, "waits"), os.environ)
        assert await process.stdout.readline() == b"waits\n"
        os.kill(prepared.pid, signal.SIGKILL)
        other = await prepared.start(_command(file, "code"), os.environ, None)
        assert process.returncode is None
        os.killpg(process.pid, signal.SIGINT)
        async with asyncio.timeout(PATIENCE_S):
            return other, await process.wait()

    with Prepared(os.environ) as prepared:
        assert asyncio.run(kill(prepared)) == (None, 130)
