"""Displays of the owner's own, each in its real process."""

from __future__ import annotations

import asyncio
import time
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

import pytest

from studio.displays.display import Display, Received
from studio.displays.drawing import Points, Text
from studio.errors import DisplayError
from studio.live.displays.plugins import PREFIX, Plugins
from tests.support.display_messages import NOW_NS, TYPES, received
from tests.support.open_documents import until
from tests.support.plugins import BAD, GOOD, drawing, example, points

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator
    from pathlib import Path

BATTERY = "sensor_msgs/msg/BatteryState"


@asynccontextmanager
async def running(*folders: Path) -> AsyncGenerator[Plugins]:
    plugins = Plugins(folders)
    plugins.start()
    try:
        await plugins.ready.wait()
        yield plugins
    finally:
        await plugins.close()


def display_of(plugins: Plugins, kind: str) -> Display:
    return plugins.of_kind(PREFIX + kind)(TYPES)


async def drawn(display: Display) -> None:
    """Let the loop run until it draws."""
    await until(lambda: bool(display.draw(time.time_ns())))


def sentences(display: Display) -> str:
    display.draw(time.time_ns())
    return " ".join(one.sentence for one in display.statuses())


def test_the_example_of_the_readme_draws_what_comes_and_takes_its_setting(tmp_path: Path):
    async def run() -> None:
        (tmp_path / "battery.py").write_text(example())
        async with running(tmp_path) as plugins:
            kind = plugins.of_kind("plugins/Battery")
            assert [role.types for role in kind.TOPICS] == [(BATTERY,)]
            assert plugins.kind_of_type(BATTERY) == "plugins/Battery"
            assert [one.name for one in kind.PROPERTIES] == ["Low"]
            display = kind(TYPES)
            display.take(received(BATTERY, {"percentage": 0.5}))
            await drawn(display)
            assert words(display) == ("50%", (80, 220, 120))
            display.set("Low", 0.6)
            await until(lambda: words(display) == ("50%", (255, 60, 40)))
            display.take(Received(BATTERY, b"\0\1\0\0", NOW_NS))
            await until(lambda: "are no sensor_msgs/msg/BatteryState" in sentences(display))
            assert words(display)[0] == "50%"

    asyncio.run(run())


def words(display: Display) -> tuple[str, tuple[int, int, int]]:
    (placed,) = display.draw(time.time_ns()).values()
    text = placed.shapes["charge"]
    assert isinstance(text, Text)
    assert (placed.frame, placed.follows) == ("map", True)
    return text.text, text.rgb


@pytest.mark.parametrize(
    "chosen",
    [
        ("raises", "blocks"),
        pytest.param(("sleeps", "exits", "dies", "swells"), marks=pytest.mark.sweep),
    ],
)
def test_one_that_fails_is_off_and_says_where_while_the_others_go_on(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], chosen: tuple[str, ...]
):
    talks = "print('hello'); sys.stderr.write('there\\n')\nfor x in range(300): print('again', x)\n"

    async def run() -> None:
        for name in chosen:
            (tmp_path / f"{name}.py").write_text(BAD[name][0])
        (tmp_path / "good.py").write_text(GOOD)
        (tmp_path / "talks.py").write_text(drawing("Talks", talks + points("np.ones((1, 3))")))
        (tmp_path / "nan.py").write_text(drawing("Nan", points("np.full((1, 3), np.nan)")))
        async with running(tmp_path) as plugins:
            bad = {name: display_of(plugins, name.title()) for name in chosen}
            good, talking, odd = (display_of(plugins, kind) for kind in ("Good", "Talks", "Nan"))
            longest_s = 0.0

            async def all_off() -> None:
                nonlocal longest_s
                while True:
                    began_s = time.perf_counter()
                    off = [not one.draw(time.time_ns()) and one.statuses() for one in bad.values()]
                    longest_s = max(longest_s, time.perf_counter() - began_s)
                    if all(off):
                        return
                    await asyncio.sleep(0.01)

            await asyncio.wait_for(all_off(), 60)
            assert longest_s < 0.5, "the loop waited for a plug-in"
            for name, display in bad.items():
                assert BAD[name][1] in sentences(display)
                assert "switched off until its file changes" in sentences(display)
            assert plugins.faults().keys() == {f"{name}.py" for name in chosen}
            await drawn(good)
            shape = good.draw(0)["cloud"].shapes["points"]
            assert isinstance(shape, Points)
            await drawn(talking)
            await until(lambda: "positions of Points are NaN" in sentences(odd))
            assert not odd.draw(0)

    asyncio.run(run())
    told = capfd.readouterr().err.splitlines()
    lines = [line for line in told if line.startswith("[display talks] ")]
    assert lines[:3] == [f"[display talks] {one}" for one in ("hello", "there", "again 0")]
    assert len(lines) == 101
    assert "left out" in lines[-1]


def names(plugins: Plugins) -> list[str]:
    return [one.KIND for one in plugins.kinds()]


def test_a_file_that_changes_is_loaded_anew_and_one_that_goes_is_gone(tmp_path: Path):
    async def run() -> None:
        path = tmp_path / "good.py"
        path.write_text(drawing("Good", "raise ValueError"))
        (tmp_path / "_helper.py").write_text("raise ValueError")
        changes: list[frozenset[str]] = []

        async def told(kinds: frozenset[str]) -> None:
            changes.append(kinds)

        async with running(tmp_path) as plugins:
            plugins.on_change(told)
            old = display_of(plugins, "Good")
            await until(lambda: bool(old.draw(time.time_ns()) or old.statuses()))
            fresh = tmp_path / "fresh"
            fresh.write_text(GOOD)
            fresh.rename(path)  # as editors save
            await until(lambda: changes == [frozenset({"plugins/Good"})])
            new = display_of(plugins, "Good")
            await drawn(new)
            assert not new.statuses()
            path.unlink()
            await until(lambda: len(changes) == 2)
            with pytest.raises(DisplayError, match="--displays"):
                display_of(plugins, "Good")

    asyncio.run(run())


def test_of_two_files_of_one_name_the_second_is_shown_once_the_first_is_gone(tmp_path: Path):
    async def run() -> None:
        for name in ("a", "b"):
            (tmp_path / f"{name}.py").write_text(GOOD)
        async with running(tmp_path) as plugins:
            assert names(plugins).count("plugins/Good") == 1
            assert plugins.faults() == {"b.py": "b.py: its KIND is that of a.py, too"}
            (tmp_path / "a.py").unlink()
            await until(lambda: not plugins.faults())
            second = display_of(plugins, "Good")
            await drawn(second)
            assert not second.statuses()

    asyncio.run(run())
