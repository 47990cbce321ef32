"""Opening files, packages, workspaces and zips, made for real."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path

import pytest

from studio.errors import (
    OutsideRootsError,
    PackageNotFoundError,
    UnreadableFileError,
    UnsafeArchiveError,
)
from studio.packages import workspace
from studio.packages.workspace import Location, open_location
from tests.support.corpus import corpus
from tests.support.packages import write_install, write_package
from tests.support.permissions import open_folder, unprivileged

ROBOT = "<robot name='r'><link name='l'/></robot>"
needs_links = pytest.mark.skipif(os.name == "nt", reason="symlinks of Unix")


class Home:
    """A data folder, an environment, and a way to open things with them."""

    def __init__(self, base: Path) -> None:
        self.data_folder = base / "data"
        self.data_folder.mkdir()
        self.environment: dict[str, str] = {}

    def open(self, path: Path, *package_paths: Path) -> Location:
        return open_location(path, package_paths, self.data_folder, self.environment)


@pytest.fixture
def home(tmp_path: Path) -> Home:
    return Home(tmp_path)


@pytest.fixture
def colcon(tmp_path: Path) -> Path:
    """A workspace as colcon leaves it: rover has source, its install is linked; arm has none."""
    ws = tmp_path / "ws"
    rover = write_package(ws / "src" / "repo" / "rover", files={"urdf/rover.urdf": ROBOT})
    write_package(ws / "src" / "lidar")
    install = write_install(ws / "install", ["rover", "arm"])
    shared = install / "rover" / "share" / "rover" / "urdf"
    shared.mkdir()
    (shared / "rover.urdf").symlink_to(rover / "urdf" / "rover.urdf")
    for name in ("build", "log"):
        write_package(ws / name / "rover")
        (ws / name / "COLCON_IGNORE").touch()
    return ws


def test_a_file_opens_itself_with_the_robots_of_its_package(home: Home, tmp_path: Path):
    package = write_package(tmp_path / "p" / "rover", files={"a.urdf": ROBOT, "urdf/b.urdf": ROBOT})
    location = home.open(package / "a.urdf")
    assert location.entry == package / "a.urdf"
    assert {one.path.name for one in location.candidates} == {"a.urdf", "b.urdf"}
    assert location.index.best("rover", package) == package


def test_a_folder_opens_its_best_robot(home: Home, tmp_path: Path):
    write_package(tmp_path / "ws" / "x_tools", files={"a.urdf": ROBOT})
    best = write_package(tmp_path / "ws" / "y_description", files={"urdf/y.urdf": ROBOT})
    location = home.open(tmp_path / "ws")
    assert location.entry == best / "urdf" / "y.urdf"
    assert location.served.all == (tmp_path / "ws",)


def test_a_folder_without_a_robot_opens_nothing_and_says_why_not(home: Home, tmp_path: Path):
    write_package(tmp_path / "ws" / "rover", files={"a.xacro": "<gazebo/>"})
    location = home.open(tmp_path / "ws")
    assert location.entry is None
    assert [one.reason for one in location.candidates] == ["root is <gazebo>"]


def test_a_package_folder_finds_the_packages_beside_it_as_its_files_do(home: Home, tmp_path: Path):
    rover = write_package(tmp_path / "ws" / "src" / "rover", files={"urdf/rover.urdf": ROBOT})
    arm = write_package(tmp_path / "ws" / "src" / "arm")
    for opened in (rover, rover / "urdf", rover / "urdf" / "rover.urdf"):
        location = home.open(opened)
        assert location.entry == rover / "urdf" / "rover.urdf"
        assert location.index.best("arm", opened) == arm


@pytest.mark.parametrize("name", ["nothing", "nothing.urdf", "nothing.zip"])
def test_what_is_not_there_is_a_sentence(home: Home, tmp_path: Path, name: str):
    with pytest.raises(UnreadableFileError, match=f"{name}: does not exist"):
        home.open(tmp_path / name)


def test_home_and_the_file_system_are_too_wide(
    home: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    for folder in (tmp_path, Path(tmp_path.anchor)):
        with pytest.raises(UnreadableFileError, match="too wide"):
            home.open(folder)
        with pytest.raises(UnreadableFileError, match="too wide"):
            home.open(home.data_folder, folder)


@needs_links
def test_in_a_colcon_workspace_the_source_wins_and_the_install_serves_the_rest(
    home: Home, colcon: Path
):
    for opened in (colcon, colcon / "src" / "repo" / "rover" / "urdf" / "rover.urdf"):
        index = home.open(opened).index
        assert index.candidates("rover", opened) == (colcon / "src" / "repo" / "rover",)
        assert index.best("arm", opened) == colcon / "install" / "arm" / "share" / "arm"
        assert index.best("lidar", opened) == colcon / "src" / "lidar"


@needs_links
def test_in_a_colcon_workspace_only_sources_are_written(home: Home, colcon: Path):
    served = home.open(colcon).served
    assert served.may_write(colcon / "src" / "repo" / "rover" / "urdf" / "rover.urdf")
    assert not served.may_write(colcon / "install" / "arm" / "share" / "arm" / "package.xml")
    assert not served.may_write(colcon / "build" / "rover" / "package.xml")


@needs_links
def test_a_symlink_installed_file_opens_and_is_saved_at_its_target(home: Home, colcon: Path):
    source = colcon / "src" / "repo" / "rover" / "urdf" / "rover.urdf"
    location = home.open(colcon / "install" / "rover" / "share" / "rover" / "urdf" / "rover.urdf")
    assert location.entry == source
    assert location.served.may_write(source)


@needs_links
def test_a_file_that_is_only_installed_opens_read_only(home: Home, colcon: Path):
    arm = colcon / "install" / "arm" / "share" / "arm"
    (arm / "arm.urdf").write_text(ROBOT)
    location = home.open(arm / "arm.urdf")
    assert location.served.read(arm / "arm.urdf") == ROBOT.encode()
    assert not location.served.may_write(arm / "arm.urdf")


@pytest.mark.parametrize("variable", ["AMENT_PREFIX_PATH", "COLCON_PREFIX_PATH"])
def test_prefixes_of_the_environment_serve_what_has_no_source_read_only(
    home: Home, tmp_path: Path, variable: str
):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    prefix = write_install(tmp_path / "opt" / "ros", ["rover", "xacro"], isolated=False)
    home.environment[variable] = str(prefix)
    location = home.open(rover / "rover.urdf")
    assert location.index.best("rover", rover) == rover
    xacro = location.index.best("xacro", rover)
    assert xacro == prefix / "share" / "xacro"
    assert location.served.serves(xacro / "package.xml")
    assert not location.served.may_write(xacro / "package.xml")


@needs_links
def test_an_isolated_prefix_path_is_one_folder_and_leads_to_the_sources_of_its_links(
    home: Home, colcon: Path, tmp_path: Path
):
    alone = write_package(tmp_path / "elsewhere" / "alone", files={"a.urdf": ROBOT})
    prefixes = [str(colcon / "install" / name) for name in ("rover", "arm")]
    home.environment["AMENT_PREFIX_PATH"] = os.pathsep.join(prefixes)
    location = home.open(alone / "a.urdf")
    installed = location.index.best("rover", alone) / "urdf" / "rover.urdf"
    assert location.served.read(installed) == ROBOT.encode()
    assert not location.served.may_write(installed)
    assert location.served.read_only == (colcon / "install", colcon / "src")


def test_ros_package_path_names_sources_and_share_folders(home: Home, tmp_path: Path):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    source = write_package(tmp_path / "catkin" / "arm")
    prefix = write_install(tmp_path / "noetic", ["arm", "leg"], isolated=False)
    paths = [str(tmp_path / "catkin"), str(prefix / "share"), "relative", str(tmp_path / "gone")]
    home.environment["ROS_PACKAGE_PATH"] = os.pathsep.join(paths)
    location = home.open(rover / "rover.urdf")
    assert location.index.best("arm", rover) == source
    assert location.index.best("leg", rover) == prefix / "share" / "leg"
    assert not location.served.may_write(source / "package.xml")


def test_an_opened_folder_stays_writable_though_the_environment_names_it(
    home: Home, tmp_path: Path
):
    rover = write_package(tmp_path / "catkin" / "src" / "rover", files={"rover.urdf": ROBOT})
    home.environment["ROS_PACKAGE_PATH"] = str(tmp_path / "catkin" / "src")
    assert home.open(rover / "rover.urdf").served.may_write(rover / "rover.urdf")


def test_a_package_path_is_searched_and_served_read_only(home: Home, tmp_path: Path):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    arm = write_package(tmp_path / "library" / "deep" / "arm")
    location = home.open(rover / "rover.urdf", tmp_path / "library")
    assert location.index.best("arm", rover) == arm
    assert location.served.serves(arm / "package.xml")
    assert not location.served.may_write(arm / "package.xml")
    with pytest.raises(OutsideRootsError):
        home.open(rover / "rover.urdf").served.read(arm / "package.xml")


@pytest.mark.parametrize("package_path", ["p", "p/rover", "p/rover/urdf"])
def test_what_is_opened_stays_writable_wherever_a_package_path_lies(
    home: Home, tmp_path: Path, package_path: str
):
    rover = write_package(tmp_path / "p" / "rover", files={"urdf/rover.urdf": ROBOT})
    location = home.open(rover / "urdf" / "rover.urdf", tmp_path / package_path)
    assert location.served.may_write(rover / "urdf" / "rover.urdf")


def test_opening_from_the_page_serves_nothing_more(home: Home, tmp_path: Path):
    source = tmp_path / "ws" / "src"
    rover = write_package(source / "repo" / "rover", files={"rover.urdf": ROBOT})
    write_package(source / "other")
    opened = home.open(source / "repo").served
    location = open_location(
        rover / "rover.urdf", (), home.data_folder, home.environment, within=opened
    )
    assert location.served.all == (source / "repo",)
    assert "other" not in location.index
    with pytest.raises(OutsideRootsError):
        open_location(source / "other", (), home.data_folder, home.environment, within=opened)


@pytest.mark.skipif(os.name == "nt", reason="modes of Unix")
def test_a_workspace_with_closed_folders_opens_without_them():
    with open_folder() as folder:
        rover = write_package(folder / "ws" / "rover", files={"rover.urdf": ROBOT})
        write_package(folder / "ws" / "closed")
        (folder / "ws" / "closed").chmod(0)
        with unprivileged():
            location = open_location(folder / "ws", (), folder / "data", {})
            with pytest.raises(UnreadableFileError, match="permissions"):
                open_location(folder / "ws" / "closed" / "a.urdf", (), folder / "data", {})
    assert location.entry == rover / "rover.urdf"
    assert location.index.names == {"rover"}


def test_what_was_read_only_stays_so_when_it_is_opened_from_the_page(home: Home, tmp_path: Path):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    arm = write_package(tmp_path / "library" / "arm", files={"arm.urdf": ROBOT})
    before = home.open(rover / "rover.urdf", tmp_path / "library").served
    location = open_location(arm / "arm.urdf", (), home.data_folder, {}, within=before)
    assert location.entry == arm / "arm.urdf"
    assert location.served.serves(arm / "arm.urdf")
    assert not location.served.may_write(arm / "arm.urdf")


@needs_links
def test_a_name_that_is_no_text_is_refused_in_a_sentence(home: Home, tmp_path: Path):
    with pytest.raises(UnreadableFileError, match="no text: rename it"):
        home.open(tmp_path / os.fsdecode(b"r\xff.urdf"))


def test_a_pipe_is_not_opened(home: Home, tmp_path: Path):
    os.mkfifo(tmp_path / "robot.urdf")
    with pytest.raises(UnreadableFileError, match="is no file and no folder"):
        home.open(tmp_path / "robot.urdf")


def test_a_package_path_that_is_an_install_space_is_read_only(home: Home, tmp_path: Path):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    prefix = write_install(tmp_path / "prefix", ["arm"])
    location = home.open(rover / "rover.urdf", prefix)
    arm = location.index.best("arm", rover)
    assert arm == prefix / "arm" / "share" / "arm"
    assert not location.served.may_write(arm / "package.xml")


def test_a_package_path_that_is_no_folder_is_a_sentence(home: Home, tmp_path: Path):
    with pytest.raises(UnreadableFileError, match="--package-path"):
        home.open(home.data_folder, tmp_path / "nothing")


def test_a_chosen_package_is_served_and_remembered_for_this_workspace_only(
    home: Home, tmp_path: Path
):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    other = write_package(tmp_path / "q" / "other", files={"other.urdf": ROBOT})
    arm = write_package(tmp_path / "far" / "away" / "arm")
    location = home.open(rover / "rover.urdf").choose_package("arm", tmp_path / "far")
    for one in (location, home.open(rover / "rover.urdf")):
        assert one.index.best("arm", rover) == arm
        assert one.served.serves(arm / "package.xml")
        assert not one.served.may_write(arm / "package.xml")
        assert not one.served.serves(tmp_path / "far" / "away")
    assert "arm" not in home.open(other / "other.urdf").index


def test_a_chosen_folder_that_is_gone_is_forgotten(home: Home, tmp_path: Path):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    bare = tmp_path / "bare"
    bare.mkdir()
    home.open(rover / "rover.urdf").choose_package("arm", bare)
    bare.rmdir()
    assert "arm" not in home.open(rover / "rover.urdf").index


def test_a_choice_must_hold_the_package_that_it_is_for(home: Home, tmp_path: Path):
    rover = write_package(tmp_path / "p" / "rover", files={"rover.urdf": ROBOT})
    location = home.open(rover / "rover.urdf")
    with pytest.raises(PackageNotFoundError):
        location.choose_package("arm", write_package(tmp_path / "leg"))
    with pytest.raises(UnreadableFileError, match="is no folder"):
        location.choose_package("arm", tmp_path / "nothing")
    with pytest.raises(UnreadableFileError, match="too wide"):
        location.choose_package("arm", Path(tmp_path.anchor))
    with pytest.raises(UnreadableFileError, match="is no file name"):
        location.choose_package("arm", tmp_path / "far\0away")


def test_a_package_that_exists_twice_is_warned_of(home: Home, tmp_path: Path):
    for repo in ("a", "b"):
        write_package(tmp_path / "ws" / repo / "arm")
    rover = write_package(tmp_path / "ws" / "b" / "rover", files={"rover.urdf": ROBOT})
    location = home.open(tmp_path / "ws")
    (problem,) = location.index.duplicates(rover / "rover.urdf")
    assert f"{tmp_path / 'ws' / 'b' / 'arm'} is used" in problem.sentence


def pack(path: Path, files: dict[str, str]) -> Path:
    with zipfile.ZipFile(path, "w") as archive:
        for name, text in files.items():
            archive.writestr(name, text)
    return path


MANIFEST = "<package><name>rover</name></package>"


def test_a_zip_is_unpacked_into_the_data_folder_and_opens_its_robot(home: Home, tmp_path: Path):
    made = pack(tmp_path / "a.zip", {"rover/package.xml": MANIFEST, "rover/rover.urdf": ROBOT})
    location = home.open(made)
    assert location.entry is not None
    assert location.entry.is_relative_to(home.data_folder / "uploads")
    assert location.served.all == (location.entry.parent,)
    assert location.index.best("rover", location.entry) == location.entry.parent


def test_what_was_edited_in_an_opened_zip_is_there_when_it_is_opened_again(
    home: Home, tmp_path: Path
):
    made = pack(tmp_path / "a.zip", {"package.xml": MANIFEST, "rover.urdf": ROBOT})
    first = home.open(made)
    assert first.entry is not None
    first.entry.write_text(ROBOT + "<!-- mine -->")
    again = home.open(made.rename(tmp_path / "b.zip"))
    assert again.entry == first.entry
    assert "mine" in first.entry.read_text()


def test_a_zip_never_serves_its_neighbours(home: Home, tmp_path: Path):
    first = home.open(pack(tmp_path / "a.zip", {"package.xml": MANIFEST, "a.urdf": ROBOT}))
    second = home.open(pack(tmp_path / "b.zip", {"package.xml": MANIFEST, "b.urdf": ROBOT}))
    assert first.entry is not None
    assert not second.served.serves(first.entry)


def test_unpacked_zips_have_a_quota(home: Home, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(workspace, "UPLOADS_QUOTA_BYTES", 1000)
    home.open(pack(tmp_path / "a.zip", {"a.urdf": ROBOT, "pad": "x" * 900}))
    with pytest.raises(UnsafeArchiveError, match=r"more than|is full"):
        home.open(pack(tmp_path / "b.zip", {"b.urdf": ROBOT, "pad": "x" * 900}))
    home.open(tmp_path / "a.zip")


def test_progress_tells_what_is_done(home: Home, tmp_path: Path):
    told: list[tuple[str, int, int]] = []

    def tell(label: str, done: int, total: int) -> None:
        told.append((label, done, total))

    made = pack(tmp_path / "a.zip", {"rover/a.urdf": ROBOT})
    open_location(made, (), home.data_folder, {}, tell)
    assert {label for label, _, _ in told} == {"unpacking a.zip", "robot files"}


@pytest.mark.corpus
def test_the_whole_corpus_is_indexed_with_every_package_that_its_files_name(home: Home):
    folder = corpus()
    location = home.open(folder)
    manifests = list(folder.rglob("package.xml"))
    assert len(location.index.packages) == len(manifests) == 142
    assert location.index.duplicates(folder) == []
    assert location.problems == ()
    assert {"ur_description", "project_description", "pr2_description"} <= location.index.names


@pytest.mark.corpus
def test_a_real_file_with_the_corpus_as_package_path_finds_what_it_includes(home: Home):
    folder = corpus()
    turtlebot = folder / "turtlebot+turtlebot4" / "turtlebot4_description" / "urdf" / "standard"
    location = home.open(turtlebot / "turtlebot4.urdf.xacro", folder)
    found = location.index.best("irobot_create_description", turtlebot)
    assert location.served.serves(found / "urdf" / "create3.urdf.xacro")
