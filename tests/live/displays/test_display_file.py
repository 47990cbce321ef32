from pathlib import Path

import pytest

from studio.live.displays.display_file import FOLDER, DisplayFile, KeptDisplays
from studio.live.displays.display_list import DisplaySpec, Listening
from studio.rviz.tools import ToolSpec

SCAN = DisplaySpec(
    "d3",
    "LaserScan",
    "Front scan",
    "/scan",
    group="Sensors",
    listening=Listening(reliable=False, depth=1),
    values={"Alpha": 0.5, "Color": "#ff0000", "Style": "Boxes", "Decay Time": 3, "Axis": True},
)
KEPT = KeptDisplays(
    (SCAN,), ("Sensors",), "odom", (ToolSpec("t1", "SetGoal", "Goal", {"Topic": "/g"}),)
)


def test_what_was_written_is_read_again_for_the_same_entry_only(tmp_path: Path):
    entry = tmp_path / "rover.urdf.xacro"
    DisplayFile(tmp_path, entry).write(KEPT)
    assert DisplayFile(tmp_path, entry).read() == KEPT
    assert DisplayFile(tmp_path, tmp_path / "other.xacro").read() == KeptDisplays()
    assert [one.suffix for one in (tmp_path / FOLDER).iterdir()] == [".json"]


@pytest.mark.parametrize(
    "data",
    [b"", b"{", b"\xff\xfe", b'{"displays": [{"id": 3}]}', b'{"displays": 7}', b"[" * 100_000],
)
def test_a_broken_file_is_as_none_and_is_written_anew(tmp_path: Path, data: bytes):
    file = DisplayFile(tmp_path, tmp_path / "a.urdf")
    file.write(KEPT)
    (written,) = (tmp_path / FOLDER).iterdir()
    written.write_bytes(data)
    assert file.read() == KeptDisplays()
    file.write(KEPT)
    assert file.read() == KEPT


def test_what_the_disk_refuses_is_logged_and_leaves_nothing_behind(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
):
    (tmp_path / FOLDER).write_text("a file where the folder would be")
    DisplayFile(tmp_path, tmp_path / "a.urdf").write(KEPT)
    assert "are not kept" in caplog.text
    assert [one.name for one in tmp_path.iterdir()] == [FOLDER]
