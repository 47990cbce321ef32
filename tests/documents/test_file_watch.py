from __future__ import annotations

import asyncio
import os
import resource
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from studio.documents.file_watch import FileWatch

if TYPE_CHECKING:
    from collections.abc import Generator


@contextmanager
def no_more_descriptors() -> Generator[None]:
    """This process may open no file more."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    lowest = os.dup(0)
    os.close(lowest)
    resource.setrlimit(resource.RLIMIT_NOFILE, (lowest, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft, hard))


def write_long_ago(path: Path) -> None:
    path.write_text("")
    os.utime(path, (1, 1))


def watched(tmp_path: Path, act: list[Path], expected: set[str]) -> None:
    """Watch two files, write those of `act` in turn until the watch has told `expected`."""

    both = [str(tmp_path / "a.xacro"), str(tmp_path / "b.xacro")]
    for one in both:
        write_long_ago(Path(one))

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()
        watch = FileWatch(told.put)
        watch.watch(both)
        heard: set[str] = set()
        try:
            while not expected <= heard:
                for number, path in enumerate(act):  # the watch needs a moment to begin
                    path.write_text(f"{number} {len(heard)} {asyncio.get_running_loop().time()}")
                try:
                    heard |= await asyncio.wait_for(told.get(), 0.3)
                except TimeoutError:
                    continue
        finally:
            await watch.close()
        assert heard == expected

    asyncio.run(run())


def test_a_written_file_is_told_and_its_neighbours_are_not(tmp_path: Path):
    a, other = tmp_path / "a.xacro", tmp_path / "other.txt"
    a.write_text("")
    watched(tmp_path, [other, a], {str(a)})


def test_a_new_file_that_fits_is_told_in_a_folder_beside(tmp_path: Path):
    beside, first = tmp_path / "config", tmp_path / "a.xacro"
    beside.mkdir()
    write_long_ago(first)

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()
        watch = FileWatch(told.put, lambda path: path.endswith(".srdf"))
        watch.watch([str(first)], [str(beside)])
        try:
            while told.empty():
                for name in ("new.txt", "new.srdf"):
                    (beside / name).write_text(str(asyncio.get_running_loop().time()))
                await asyncio.sleep(0.1)
            assert await told.get() == {str(beside / "new.srdf")}
        finally:
            await watch.close()

    asyncio.run(run())


def test_a_file_that_an_editor_replaces_is_told(tmp_path: Path):
    a = tmp_path / "a.xacro"
    a.write_text("")

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()
        watch = FileWatch(told.put)
        watch.watch([str(a)])
        try:
            while told.empty():
                new = tmp_path / "a.xacro.swp"
                new.write_text("new")
                new.replace(a)
                await asyncio.sleep(0.1)
            assert await told.get() == {str(a)}
        finally:
            await watch.close()

    asyncio.run(run())


def test_what_changes_before_the_watch_stands_is_told_and_what_is_older_is_not(tmp_path: Path):
    old, new, gone = (tmp_path / name for name in ("old.xacro", "new.xacro", "gone.xacro"))
    for one in (old, gone):
        write_long_ago(one)

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()
        watch = FileWatch(told.put)
        new.write_text("")
        gone.unlink()
        watch.watch([str(old), str(new), str(gone)])
        try:
            assert await told.get() == {str(new), str(gone)}
        finally:
            await watch.close()

    asyncio.run(run())


def test_a_watch_that_the_system_refuses_is_told_tried_again_and_can_be_closed(tmp_path: Path):
    a = tmp_path / "a.xacro"
    write_long_ago(a)

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()
        troubles: asyncio.Queue[str] = asyncio.Queue()
        watch = FileWatch(told.put, troubled=troubles.put_nowait)
        with no_more_descriptors():
            watch.watch([str(a)])
            assert "open files" in await troubles.get()
        a.write_text("written while nobody watched")
        assert await told.get() == {str(a)}
        assert await troubles.get() == ""
        await watch.close()

    asyncio.run(run())


def test_a_watch_that_the_system_refuses_can_be_closed(tmp_path: Path):
    async def run() -> None:
        troubles: asyncio.Queue[str] = asyncio.Queue()
        watch = FileWatch(asyncio.Queue[set[str]]().put, troubled=troubles.put_nowait)
        with no_more_descriptors():
            watch.watch([str(tmp_path / "a.xacro")])
            await troubles.get()
            await watch.close()

    asyncio.run(run())


def test_who_cannot_take_a_change_does_not_end_the_watch(tmp_path: Path):
    a = tmp_path / "a.xacro"
    write_long_ago(a)

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()

        async def take(paths: set[str]) -> None:
            await told.put(paths)
            raise ValueError(paths)

        watch = FileWatch(take)
        watch.watch([str(a)])
        for _ in range(2):
            while told.empty():
                a.write_text(str(asyncio.get_running_loop().time()))
                await asyncio.sleep(0.1)
            told.get_nowait()
        await watch.close()

    asyncio.run(run())
