"""What may be read and written, over real files, links, pipes and devices."""

from __future__ import annotations

import os
import socket
from pathlib import Path

import pytest

from studio.errors import OutsideRootsError, UnreadableFileError
from studio.packages.roots import ServedRoots, is_below, served_roots_for
from tests.support.packages import write_package
from tests.support.permissions import open_folder, unprivileged

needs_links = pytest.mark.skipif(os.name == "nt", reason="symlinks and pipes of Unix")


@pytest.fixture
def root(tmp_path: Path) -> Path:
    folder = tmp_path / "root"
    folder.mkdir()
    (folder / "robot.urdf").write_text("<robot/>")
    (tmp_path / "secret.txt").write_text("secret")
    return folder


def test_a_file_below_a_root_is_read(root: Path):
    assert ServedRoots([root]).read(root / "robot.urdf") == b"<robot/>"


@pytest.mark.parametrize("name", ["../secret.txt", "a/../../secret.txt", "/etc/passwd", "/"])
def test_a_path_out_of_the_roots_is_refused(root: Path, name: str):
    with pytest.raises(OutsideRootsError, match="lies outside the opened folders"):
        ServedRoots([root]).read(root / name)


def test_a_folder_whose_name_only_begins_like_a_root_is_outside(tmp_path: Path, root: Path):
    (tmp_path / "root2").mkdir()
    (tmp_path / "root2" / "a").write_text("a")
    with pytest.raises(OutsideRootsError):
        ServedRoots([root]).read(tmp_path / "root2" / "a")


def test_what_does_not_exist_outside_is_told_as_outside_not_as_missing(root: Path):
    with pytest.raises(OutsideRootsError):
        ServedRoots([root]).read(root / ".." / "no-such-file")


@needs_links
def test_a_symlink_out_of_the_roots_is_refused(tmp_path: Path, root: Path):
    (root / "link.urdf").symlink_to(tmp_path / "secret.txt")
    (root / "folder").symlink_to(tmp_path)
    served = ServedRoots([root])
    for path in (root / "link.urdf", root / "folder" / "secret.txt"):
        with pytest.raises(OutsideRootsError):
            served.read(path)
        assert not served.may_write(path)


@needs_links
def test_a_symlink_inside_the_roots_is_read_at_its_target(root: Path):
    (root / "link.urdf").symlink_to("robot.urdf")
    served = ServedRoots([root])
    assert served.resolve(root / "link.urdf") == root / "robot.urdf"
    assert served.read(root / "link.urdf") == b"<robot/>"


@needs_links
def test_a_root_that_is_itself_a_symlink_is_served(tmp_path: Path, root: Path):
    (tmp_path / "alias").symlink_to(root)
    assert ServedRoots([tmp_path / "alias"]).read(tmp_path / "alias" / "robot.urdf") == b"<robot/>"


@needs_links
def test_a_symlink_loop_is_a_sentence(root: Path):
    (root / "loop").symlink_to("loop")
    with pytest.raises(UnreadableFileError, match="leads back to itself"):
        ServedRoots([root]).read(root / "loop")


@needs_links
def test_a_pipe_is_refused_and_does_not_block(root: Path):
    os.mkfifo(root / "pipe.urdf")
    with pytest.raises(UnreadableFileError, match="pipe, device or socket"):
        ServedRoots([root]).read(root / "pipe.urdf")


@needs_links
@pytest.mark.parametrize("device", ["/dev/zero", "/dev/stdin", "/dev/null"])
def test_a_device_is_refused_even_when_served(device: str):
    with pytest.raises((UnreadableFileError, OutsideRootsError)):
        ServedRoots([Path("/dev")]).read(Path(device))


@needs_links
def test_a_socket_is_refused(root: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(root)  # the path of a socket may be 108 bytes at most
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind("s")
        with pytest.raises(UnreadableFileError, match="socket"):
            ServedRoots([root]).read(root / "s")


def test_a_folder_is_no_file(root: Path):
    with pytest.raises(UnreadableFileError, match="is a folder, not a file"):
        ServedRoots([root]).read(root)


@pytest.mark.parametrize("name", ["missing.urdf", "robot.urdf/below"])
def test_a_missing_file_is_a_sentence_with_its_name(root: Path, name: str):
    with pytest.raises(UnreadableFileError, match=f"{name}: does not exist"):
        ServedRoots([root]).read(root / name)


@pytest.mark.parametrize("name", ["a\0b", "x" * 5000])
def test_a_name_that_no_file_can_have_is_a_sentence(root: Path, name: str):
    with pytest.raises(UnreadableFileError):
        ServedRoots([root]).read(root / name)


def test_a_file_over_the_limit_is_not_read_and_one_at_the_limit_is(root: Path):
    served = ServedRoots([root])
    assert served.read(root / "robot.urdf", limit_bytes=8) == b"<robot/>"
    with pytest.raises(UnreadableFileError, match="is larger than"):
        served.read(root / "robot.urdf", limit_bytes=7)


@needs_links
def test_a_file_that_tells_no_size_is_still_counted():
    """Files of /proc have size 0 and content."""
    proc = Path("/proc/self")
    if not proc.exists():
        pytest.skip("no /proc here")
    with pytest.raises(UnreadableFileError, match="is larger than"):
        ServedRoots([proc]).read(Path(os.path.realpath(proc)) / "status", limit_bytes=10)


@needs_links
def test_a_file_without_permission_is_a_sentence_and_not_written():
    with open_folder() as folder:
        (folder / "robot.urdf").touch()
        (folder / "robot.urdf").chmod(0)
        served = ServedRoots([folder])
        with unprivileged(), pytest.raises(UnreadableFileError, match="permissions forbid it"):
            served.read(folder / "robot.urdf")
        with unprivileged():
            assert not served.may_write(folder / "robot.urdf")
            assert not served.may_write(folder / "new.urdf")


def test_writing_is_for_writable_roots_only(tmp_path: Path, root: Path):
    (tmp_path / "system").mkdir()
    (tmp_path / "system" / "a.urdf").touch()
    served = ServedRoots([root], read_only=[tmp_path / "system"])
    assert served.may_write(root / "robot.urdf")
    assert served.may_write(root / "new.urdf")
    assert not served.may_write(root)
    assert not served.may_write(tmp_path / "system" / "a.urdf")
    assert not served.may_write(tmp_path / "secret.txt")


def test_the_innermost_root_decides_about_writing(root: Path):
    install = root / "install"
    (install / "own").mkdir(parents=True)
    served = ServedRoots([root, install / "own"], read_only=[install])
    assert not served.may_write(install / "a")
    assert served.may_write(install / "own" / "a")


@needs_links
def test_a_symlink_installed_file_is_saved_at_its_target(root: Path):
    (root / "install").mkdir()
    (root / "install" / "robot.urdf").symlink_to(root / "robot.urdf")
    served = ServedRoots([root], read_only=[root / "install"])
    assert served.resolve(root / "install" / "robot.urdf") == root / "robot.urdf"
    assert served.may_write(root / "install" / "robot.urdf")


def test_a_root_may_be_added(tmp_path: Path, root: Path):
    served = ServedRoots([root]).with_roots([tmp_path])
    assert served.read(tmp_path / "secret.txt") == b"secret"


def test_is_below_compares_whole_names():
    assert is_below(Path("/a/b"), Path("/a"))
    assert is_below(Path("/a"), Path("/a"))
    assert is_below(Path("/a"), Path("/"))
    assert not is_below(Path("/ab"), Path("/a"))


def test_a_folder_serves_itself(tmp_path: Path):
    assert served_roots_for(tmp_path) == (tmp_path,)


def test_a_file_in_no_package_serves_its_folder_only(root: Path):
    assert served_roots_for(root / "robot.urdf") == (root,)


def test_a_file_serves_the_nearest_repository_around_its_package(tmp_path: Path):
    package = write_package(tmp_path / "repo" / "group" / "rover")
    (tmp_path / "repo" / ".git").mkdir()
    (tmp_path / ".git").mkdir()
    assert served_roots_for(package / "package.xml") == (tmp_path / "repo",)


def test_a_file_serves_the_src_of_its_workspace_with_all_repositories_in_it(tmp_path: Path):
    package = write_package(tmp_path / "ws" / "src" / "repo" / "rover")
    (tmp_path / "ws" / "src" / "repo" / ".git").mkdir()
    assert served_roots_for(package / "package.xml") == (tmp_path / "ws" / "src",)


def test_a_repository_more_than_three_levels_up_does_not_count(tmp_path: Path):
    package = write_package(tmp_path / "a" / "b" / "c" / "rover")
    (tmp_path / ".git").mkdir()
    assert served_roots_for(package / "package.xml") == (package,)


def test_without_a_repository_the_packages_beside_it_are_served_and_nothing_else(tmp_path: Path):
    package = write_package(tmp_path / "rover")
    beside = write_package(tmp_path / "wheels")
    (tmp_path / "letters").mkdir()
    assert served_roots_for(package / "package.xml") == (package, beside)


def test_home_is_never_served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    (tmp_path / ".git").mkdir()
    package = write_package(tmp_path / "rover")
    (tmp_path / "alone.urdf").touch()
    assert served_roots_for(package / "package.xml") == (package,)
    assert served_roots_for(tmp_path / "alone.urdf") == (tmp_path / "alone.urdf",)
    for folder in (tmp_path, tmp_path.parent, Path("/")):
        with pytest.raises(UnreadableFileError, match="too wide"):
            served_roots_for(folder)


def test_a_file_served_alone_does_not_serve_its_neighbours(root: Path):
    served = ServedRoots([root / "robot.urdf"])
    assert served.read(root / "robot.urdf") == b"<robot/>"
    assert not served.serves(root / "other.urdf")
    assert not served.serves(root)


def test_opening_what_is_not_there_is_a_sentence(tmp_path: Path):
    with pytest.raises(UnreadableFileError, match="does not exist"):
        served_roots_for(tmp_path / "nothing.urdf")
