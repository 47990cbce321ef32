"""Hostile files, and a real worker process that they are opened in."""

from __future__ import annotations

import asyncio
import contextlib
from typing import TYPE_CHECKING, NamedTuple

from studio.description.client import DescriptionWorker
from studio.description.values import Expansion, Failure, OpenRequest
from tests.support.descriptions import policy_for, robot, write
from tests.support.patience import Stopwatch

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping
    from pathlib import Path

    from studio.description.values import ReadPolicy

WITHIN_S = 3.0
GOOD = robot('<link name="a${1+1}"/>')


def expression(text: str) -> str:
    """A robot with one expression."""
    return robot(f'<x v="${{{text}}}"/>')


def loaded(yaml: str, then: str = "") -> dict[str, str]:
    """A robot that reads a YAML file, and the file."""
    return {"a.xacro": expression(f"xacro.load_yaml('c.yaml'){then}"), "c.yaml": yaml}


def properties(**values: str) -> str:
    """Properties by name."""
    return "".join(f'<xacro:property name="{n}" value="{v}"/>' for n, v in values.items())


def chain(name: str, start: str, operation: str, length: int = 40) -> str:
    """Properties `name0` to `name<length>`, each made of the one before, which `@` stands for."""
    links = {f"{name}{n + 1}": operation.replace("@", f"{name}{n}") for n in range(length)}
    return properties(**{f"{name}0": start}, **links)


class Opened(NamedTuple):
    """What became of a file, and how long it took."""

    answer: Expansion | Failure
    seconds: float


class HostileStudio:
    """One worker, used for file after file."""

    def __init__(self) -> None:
        self._runner = asyncio.Runner()
        self._worker = DescriptionWorker()

    def open(self, file: Path, policy: ReadPolicy | None = None) -> Opened:
        """Open a file as the studio does."""
        request = OpenRequest(str(file), {}, policy or policy_for(file.parent), {})
        if self._worker.pid is None:
            self._runner.run(self._worker.warm())
        watch = Stopwatch()
        answer = self._runner.run(self._worker.open(request))
        return Opened(answer, watch.s)

    def survives(self, folder: Path) -> bool:
        """Whether a good robot can be opened now."""
        good = write(folder, {"good/good.xacro": GOOD})
        answer, _ = self.open(good)
        return isinstance(answer, Expansion) and answer.part_order == ("link:a2",)

    def close(self) -> None:
        """End the process."""
        self._runner.run(self._worker.close())
        self._runner.close()


@contextlib.contextmanager
def hostile_studio() -> Generator[HostileStudio]:
    """A worker for one file of tests."""
    studio = HostileStudio()
    try:
        yield studio
    finally:
        studio.close()


def stopped(studio: HostileStudio, files: Mapping[str, str | bytes], folder: Path) -> Failure:
    """See a hostile file refused in time by its worker, which opens the next; what was said."""
    answer, seconds = studio.open(write(folder, files))
    assert isinstance(answer, Failure), "it was expanded"
    assert seconds < WITHIN_S
    ended = {"worker-died", "worker-timeout"}
    assert answer.problem.code not in ended, answer.problem.sentence
    assert 10 < len(answer.problem.sentence) < 500
    assert answer.problem.place is not None
    assert studio.survives(folder)
    return answer
