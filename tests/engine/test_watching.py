import asyncio
import os
from pathlib import Path

from studio.engine.watching import FileWatch


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
