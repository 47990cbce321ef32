"""Opening a file while others rename what lies on the way."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from studio.errors import OutsideRootsError, UnreadableFileError
from studio.packages.roots import NotRegularError, ServedRoots, open_regular

needs_links = pytest.mark.skipif(os.name == "nt", reason="symlinks and pipes of Unix")


@pytest.fixture
def root(tmp_path: Path) -> Path:
    folder = tmp_path / "root"
    (folder / "a" / "b").mkdir(parents=True)
    (folder / "a" / "b" / "robot.urdf").write_text("<robot/>")
    (tmp_path / "secret.txt").write_text("secret")
    return folder


def test_a_file_is_opened_below_a_root_and_as_the_root_itself(root: Path):
    file = root / "a" / "b" / "robot.urdf"
    for served in (root, file.parent, file):
        descriptor = open_regular(served, file)
        assert os.read(descriptor, 100) == b"<robot/>"
        os.close(descriptor)


@needs_links
@pytest.mark.parametrize("step", ["a", "a/b", "a/b/robot.urdf"])
def test_a_link_that_took_the_place_of_any_step_is_not_followed(root: Path, step: str):
    (root / step).rename(root.parent / "real")
    (root / step).symlink_to(root.parent / "real")
    with pytest.raises(OSError, match=r".*"):
        open_regular(root, root / "a" / "b" / "robot.urdf")


@needs_links
def test_a_pipe_that_took_the_place_of_the_file_is_not_opened(root: Path):
    (root / "a" / "b" / "robot.urdf").unlink()
    os.mkfifo(root / "a" / "b" / "robot.urdf")
    with pytest.raises(NotRegularError):
        open_regular(root, root / "a" / "b" / "robot.urdf")


@needs_links
def test_no_descriptor_is_left_open(root: Path):
    if not Path("/proc/self/fd").exists():
        pytest.skip("no /proc here")
    before = len(list(Path("/proc/self/fd").iterdir()))
    for name in ("a", "a/b/missing", "a/missing/x"):
        with pytest.raises(OSError, match=r".*"):
            open_regular(root, root / name)
    assert len(list(Path("/proc/self/fd").iterdir())) == before


@needs_links
def test_a_file_swapped_for_a_link_at_any_moment_never_gives_away_what_is_outside(
    tmp_path: Path, root: Path
):
    """One thread swaps a folder for a link outwards and back; no read may see the outside."""
    (root / "inner").mkdir()
    (root / "inner" / "secret.txt").write_text("inside")
    (root / "outwards").symlink_to(tmp_path)
    stop = threading.Event()

    def swap() -> None:
        while not stop.is_set():
            (root / "inner").rename(root / "held")
            (root / "outwards").rename(root / "inner")
            (root / "inner").rename(root / "outwards")
            (root / "held").rename(root / "inner")

    swapper = threading.Thread(target=swap)
    swapper.start()
    served, seen, reads = ServedRoots([root]), set[str](), 0
    try:
        # Both must be met, else nothing was swapped under a read; the time limit ends it otherwise.
        while reads < 3000 or not {"inside", "OutsideRootsError"} <= seen:
            reads += 1
            try:
                seen.add(served.read(root / "inner" / "secret.txt").decode())
            except (OutsideRootsError, UnreadableFileError) as error:
                seen.add(type(error).__name__)
    finally:
        stop.set()
        swapper.join()
    assert "secret" not in seen
