import asyncio
from pathlib import Path

from studio.engine.watching import FileWatch


def watched(tmp_path: Path, act: list[Path], expected: set[str]) -> None:
    """Watch two files, write those of `act` in turn until the watch has told `expected`."""

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()
        watch = FileWatch(told.put)
        watch.watch([str(tmp_path / "a.xacro"), str(tmp_path / "b.xacro")])
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
    beside = tmp_path / "config"
    beside.mkdir()

    async def run() -> None:
        told: asyncio.Queue[set[str]] = asyncio.Queue()
        watch = FileWatch(told.put, lambda path: path.endswith(".srdf"))
        watch.watch([str(tmp_path / "a.xacro")], [str(beside)])
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
