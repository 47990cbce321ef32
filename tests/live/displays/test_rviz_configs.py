"""`.rviz` files opened and saved in a document: with real files; no router is needed."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest
import yaml

from studio.errors import (
    CommandError,
    NotAllowedError,
    NotSavedError,
    OutsideRootsError,
    RvizConfigError,
    StudioError,
)
from studio.protocol.displays import (
    ArrangeGroup,
    RemoveDisplay,
    SetDisplayProperty,
    SetFixedFrame,
    SwitchDisplays,
)
from studio.protocol.roles import Role
from studio.protocol.rviz_configs import (
    CloseRvizConfig,
    GetRvizText,
    GetRvizView,
    ListRvizFiles,
    OpenRvizFile,
    OpenRvizText,
    SaveRvizFile,
    SetViewOptions,
    UndoRvizConfig,
    ViewValues,
)
from studio.protocol.views import MoveView, RenameView
from tests.support.open_documents import Ear, engine, opened, until

if TYPE_CHECKING:
    from collections.abc import AsyncGenerator, Callable, Coroutine
    from pathlib import Path

    from studio.documents.document import Document
    from studio.documents.engine import Engine
    from studio.protocol import Command

FILE = """Panels:
  - Class: rviz_common/Displays
    Name: Displays
Visualization Manager:
  Class: ""
  Displays:
    - Alpha: 0.25
      Class: rviz_default_plugins/Grid
      Enabled: true
      Name: Floor
      Value: true
    - Class: rviz_common/Group
      Displays:
        - Class: moveit_rviz_plugin/MotionPlanning
          Enabled: true
          Name: Planning
          Planned Path:
            Loop Animation: false
          Value: true
        - Class: rviz_default_plugins/Axes
          Enabled: false
          Length: 2
          Name: Axes
          Value: false
      Enabled: false
      Name: Arm
      Value: false
  Enabled: true
  Global Options:
    Background Color: 1; 2; 3
    Fixed Frame: tip
    Frame Rate: 12
  Name: root
  Tools:
    - Class: rviz_default_plugins/MoveCamera
    - Class: nav2_rviz_plugins/GoalTool
  Value: true
  Views:
    Current:
      Class: rviz_default_plugins/Orbit
      Distance: 3
      Name: Current View
    Saved: ~
"""
ROBOT = '<robot name="arm"><link name="base"/></robot>'


class Opened:
    """A document with a page's ear at it."""

    def __init__(self, made: Engine, document: Document, ear: Ear) -> None:
        self.engine, self.document, self.ear = made, document, ear

    async def do(self, command: Command, ear: Ear | None = None) -> None:
        asked = command.model_copy(update={"document": self.document.id})
        await self.engine.execute(asked, ear or self.ear)

    @property
    def displays(self) -> list[dict[str, Any]]:
        return self.ear.last("live_displays")["displays"]

    @property
    def state(self) -> dict[str, Any]:
        return self.ear.last("rviz_config_state")

    async def changed(self) -> None:
        """Wait until the mark of unsaved changes is there."""
        await until(lambda: self.state["changed"])


@asynccontextmanager
async def arm(folder: Path) -> AsyncGenerator[Opened]:
    entry = folder / "arm.urdf"
    entry.write_text(ROBOT)
    async with engine(folder / "data") as made:
        document, ear = await opened(made, entry)
        made.attach(ear)
        yield Opened(made, document, ear)


def with_arm(folder: Path, work: Callable[[Opened], Coroutine[Any, Any, None]]) -> None:
    async def run() -> None:
        async with arm(folder) as one:
            await work(one)

    asyncio.run(run())


def test_a_file_is_shown_with_its_losses_and_comes_back_as_it_was(tmp_path: Path):
    async def work(one: Opened) -> None:
        await one.do(OpenRvizText(name="arm.rviz", text=FILE))
        answer = one.ear.last("rviz_config_opened")
        assert (answer["displays"], answer["tools"]) == (2, 1)
        assert {(each["reason"], each["what"]) for each in answer["losses"]} == {
            ("no_display", "moveit_rviz_plugin/MotionPlanning"),
            ("no_tool", "nav2_rviz_plugins/GoalTool"),
        }
        assert answer["view"]["values"] == {"Distance": 3.0}
        assert [(each["name"], each["group"], each["enabled"]) for each in one.displays] == [
            ("Floor", "", True),
            ("Planning", "Arm", True),
            ("Axes", "Arm", False),
        ]
        shown = one.ear.last("live_displays")
        assert shown["fixed_frame"] == "tip"
        assert shown["groups_off"] == ["Arm"]
        assert (shown["background"], shown["frame_rate"]) == ("#010203", 12)
        assert one.displays[0]["values"]["Alpha"] == 0.25
        await one.do(GetRvizText())
        assert one.ear.last("rviz_text")["text"] == FILE
        assert one.state == {
            "type": "rviz_config_state",
            "name": "arm.rviz",
            "path": "",
            "changed": False,
            "rviz1": False,
            "undo": True,
        }

    with_arm(tmp_path, work)


def test_only_what_was_changed_is_written_otherwise(tmp_path: Path):
    async def work(one: Opened) -> None:
        await one.do(OpenRvizText(name="arm.rviz", text=FILE))
        floor, planning, axes = (each["id"] for each in one.displays)
        await one.do(SetDisplayProperty(display=floor, name="Color", value="#ff0000"))
        await one.do(SwitchDisplays(display=axes, enabled=True))
        await one.do(SwitchDisplays(display=planning, enabled=False))
        await one.do(SetFixedFrame(frame="base"))
        await one.do(SetViewOptions(background="", frame_rate=0))
        await one.changed()
        await one.do(GetRvizText(view=ViewValues(kind="Orbit", values={"Distance": 4.0})))
        before, after = (yaml.safe_load(each) for each in (FILE, one.ear.last("rviz_text")["text"]))
        was = before["Visualization Manager"]
        was["Displays"][0]["Color"] = "255; 0; 0"
        inner = was["Displays"][1]["Displays"]
        inner[0] |= {"Enabled": False, "Value": False}
        inner[1] |= {"Enabled": True, "Value": True}
        was["Global Options"] |= {
            "Fixed Frame": "base",
            "Studio": {"Background Color": "theme", "Frame Rate": 0},
        }
        was["Views"]["Current"]["Distance"] = 4
        assert after == before

    with_arm(tmp_path, work)


def test_undo_brings_back_what_was_shown_until_something_else_is_changed(tmp_path: Path):
    async def work(one: Opened) -> None:
        await one.do(OpenRvizText(name="first.rviz", text=FILE))
        floor = one.displays[0]["id"]
        await one.do(RemoveDisplay(display=floor))
        await one.do(OpenRvizText(name="second.rviz", text=FILE.replace("Floor", "Ground")))
        assert [each["name"] for each in one.displays] == ["Ground", "Planning", "Axes"]
        await one.do(UndoRvizConfig())
        assert [each["name"] for each in one.displays] == ["Planning", "Axes"]
        assert one.state["name"] == "first.rviz"
        assert one.state["changed"]
        with pytest.raises(CommandError, match="any more"):
            await one.do(UndoRvizConfig())
        await one.do(OpenRvizText(name="second.rviz", text=FILE))
        assert one.state["undo"]
        await one.do(SetFixedFrame(frame="base"))
        await until(lambda: not one.state["undo"])
        with pytest.raises(CommandError, match="any more"):
            await one.do(UndoRvizConfig())

    with_arm(tmp_path, work)


def test_a_file_is_opened_saved_listed_and_remembered(tmp_path: Path):
    folder = tmp_path / "arm_description"
    (folder / "rviz").mkdir(parents=True)
    (folder / "package.xml").write_text(
        '<package format="3"><name>arm_description</name><version>1.0.0</version></package>'
    )
    file = folder / "rviz" / "view.rviz"
    file.write_text(FILE)

    async def work(one: Opened) -> None:
        await one.do(ListRvizFiles())
        listed = one.ear.last("rviz_files")
        assert [(each["name"], each["time_s"]) for each in listed["files"]] == [("view.rviz", None)]
        assert listed["folder"] == str(folder / "rviz")
        await one.do(OpenRvizFile(path="package://arm_description/rviz/view.rviz"))
        await one.do(SetDisplayProperty(display=one.displays[0]["id"], name="Alpha", value=0.5))
        await one.changed()
        await one.do(SaveRvizFile())
        assert file.read_text() == FILE.replace("0.25", "0.5")
        assert one.state == {**one.state, "path": str(file), "changed": False}
        await one.do(SaveRvizFile(path="other"))
        assert one.ear.last("rviz_file_saved")["path"] == str(folder / "other.rviz")
        await one.do(OpenRvizFile(path="rviz/view.rviz"))
        await one.do(SaveRvizFile(path="other.rviz"))
        assert one.ear.last("rviz_file_saved")["is_there"]
        await one.do(SaveRvizFile(path="other.rviz", replace=True))
        assert not one.ear.last("rviz_file_saved")["is_there"]
        await one.do(ListRvizFiles())
        names = [each["name"] for each in one.ear.last("rviz_files")["files"]]
        assert names == ["other.rviz", "view.rviz"]
        await one.do(CloseRvizConfig())
        assert one.state["name"] == ""

    with_arm(folder, work)


def test_a_launch_file_that_was_opened_as_a_config_is_not_written(tmp_path: Path):
    folder = tmp_path / "arm_description"
    folder.mkdir()
    file, link = folder / "view.launch.yaml", folder / "link.rviz"
    text = f"launch: []\n{FILE}"
    file.write_text(text)
    link.symlink_to(folder / "new.launch.yaml")

    async def work(one: Opened) -> None:
        await one.do(OpenRvizFile(path="view.launch.yaml"))
        await one.do(SetDisplayProperty(display=one.displays[0]["id"], name="Alpha", value=0.5))
        await one.changed()
        for command in (SaveRvizFile(), SaveRvizFile(path="link.rviz")):
            with pytest.raises(NotSavedError, match="program"):
                await one.do(command)
        assert file.read_text() == text
        assert not (folder / "new.launch.yaml").exists()

    with_arm(folder, work)


def test_what_was_opened_is_there_after_a_restart_with_its_file(tmp_path: Path):
    async def first(one: Opened) -> None:
        await one.do(OpenRvizText(name="arm.rviz", text=FILE))

    async def second(one: Opened) -> None:
        assert [each["name"] for each in one.displays] == ["Floor", "Planning", "Axes"]
        await until(lambda: one.state["name"] != "")
        assert (one.state["name"], one.state["changed"]) == ("arm.rviz", False)
        await one.do(GetRvizText())
        assert one.ear.last("rviz_text")["text"] == FILE

    with_arm(tmp_path, first)
    with_arm(tmp_path, second)


VIEWS = """
      - {Class: rviz_default_plugins/Orbit, Extra: 1, Name: A}
      - {Class: rviz_default_plugins/Orbit, Extra: 2, Name: B}
      - {Class: other/Fisheye, Name: Fish}
"""


def test_moved_and_renamed_views_and_empty_groups_keep_all_that_the_file_says(tmp_path: Path):
    file = tmp_path / "views.rviz"
    later = "    - {Class: rviz_common/Group, Displays: [], Enabled: false, Name: Later}\n"
    told = FILE.replace("Saved: ~", f"Saved: {VIEWS}").replace(
        "Displays:\n", "Displays:\n" + later, 1
    )
    file.write_text(told)

    def saved() -> list[tuple[str, int | None]]:
        manager = yaml.safe_load(file.read_text())["Visualization Manager"]
        return [(one["Name"], one.get("Extra")) for one in manager["Views"]["Saved"]]

    async def work(one: Opened) -> None:
        await one.do(OpenRvizFile(path=str(file)))
        assert not one.state["changed"]
        assert "Later" not in [display["name"] for display in one.displays]
        first, second = [view["id"] for view in one.ear.last("saved_views")["views"]]
        await one.do(MoveView(view=second, before=first))
        await one.changed()
        await one.do(SaveRvizFile(request=1))
        assert saved() == [("B", 2), ("Fish", None), ("A", 1)]
        for name in ("C", "D"):  # the second time it has another name in the file already
            await one.do(RenameView(view=second, name=name))
            await one.do(SaveRvizFile(request=2))
        assert saved() == [("D", 2), ("Fish", None), ("A", 1)]
        group = yaml.safe_load(file.read_text())["Visualization Manager"]["Displays"][0]
        assert group == yaml.safe_load(later)[0]

    with_arm(tmp_path, work)


def test_a_group_that_is_renamed_keeps_what_the_file_says_of_it(tmp_path: Path):
    file = tmp_path / "groups.rviz"
    inner = "        - {Class: rviz_common/Group, Displays: [], Name: Inner}\n"
    told = FILE.replace("      Displays:\n", f"      Displays:\n{inner}", 1)
    file.write_text(told.replace("      Name: Arm\n", "      Extra: 1\n      Name: Arm\n"))

    async def work(one: Opened) -> None:
        await one.do(OpenRvizFile(path=str(file)))
        before = yaml.safe_load(file.read_text())["Visualization Manager"]["Displays"]
        for path, to in (("Arm", "Whole/Left arm"), ("Whole", "All")):
            await one.do(ArrangeGroup(group=path, to=to))
        await one.do(SaveRvizFile(request=1))
        floor, outer = yaml.safe_load(file.read_text())["Visualization Manager"]["Displays"]
        (group,) = outer["Displays"]
        assert (floor, outer["Name"]) == (before[0], "All")
        assert group == {**before[1], "Name": "Left arm"}
        await one.do(ArrangeGroup(group="All/Left arm", to=""))
        await one.do(SaveRvizFile(request=1))
        _, outer = yaml.safe_load(file.read_text())["Visualization Manager"]["Displays"]
        assert [each["Name"] for each in outer["Displays"]] == ["Inner", "Planning", "Axes"]

    with_arm(tmp_path, work)


def test_a_document_without_a_file_is_written_with_all_that_rviz2_writes(tmp_path: Path):
    async def work(one: Opened) -> None:
        await one.do(GetRvizText())
        tree = yaml.safe_load(one.ear.last("rviz_text")["text"])
        manager = tree["Visualization Manager"]
        assert one.ear.last("rviz_text")["name"] == "arm.rviz"
        assert [each["Class"].partition("/")[2] for each in manager["Tools"]] == [
            "Interact", "MoveCamera", "Select", "FocusCamera", "Measure", "SetInitialPose",
            "SetGoal", "PublishPoint",
        ]  # fmt: skip
        assert manager["Global Options"] == {
            "Background Color": "48; 48; 48", "Fixed Frame": "base", "Frame Rate": 30,
            "Studio": {"Background Color": "theme", "Frame Rate": 0},
        }  # fmt: skip

    with_arm(tmp_path, work)


def folders(tmp_path: Path) -> tuple[Path, Path]:
    """The folder of a robot, and a config file of another one with another beside it."""
    folder, file = tmp_path / "robot", tmp_path / "elsewhere" / "view.rviz"
    for each in (folder, file.parent):
        each.mkdir()
    for each in (file, file.with_name("other.rviz")):
        each.write_text(FILE)
    return folder, file


def test_only_the_file_that_the_command_line_named_is_open_outside_the_folders(tmp_path: Path):
    folder, file = folders(tmp_path)
    other, new = (str(file.with_name(name)) for name in ("other.rviz", "new.rviz"))

    async def work(one: Opened) -> None:
        with pytest.raises(OutsideRootsError):
            await one.do(OpenRvizFile(path=str(file)))
        await one.document.configs.open_path(file)
        await one.do(SetDisplayProperty(display=one.displays[0]["id"], name="Alpha", value=0.5))
        await one.do(SaveRvizFile())
        assert file.read_text() == FILE.replace("0.25", "0.5")
        await one.do(ListRvizFiles())
        assert [each["path"] for each in one.ear.last("rviz_files")["files"]] == [str(file)]
        await one.do(OpenRvizText(name="own.rviz", text=FILE))
        await one.do(OpenRvizFile(path=str(file)))
        assert one.displays[0]["values"]["Alpha"] == 0.5
        for command in (
            OpenRvizFile(path=other),
            *(SaveRvizFile(path=path, replace=True) for path in (other, new)),
        ):
            with pytest.raises(OutsideRootsError):
                await one.do(command)
        with pytest.raises(NotAllowedError):
            await one.do(OpenRvizFile(path=str(file)), Ear(Role.STUDENT))

    with_arm(folder, work)


def test_it_is_saved_after_a_restart_too_as_long_as_it_is_the_open_one(tmp_path: Path):
    folder, file = folders(tmp_path)

    async def first(one: Opened) -> None:
        await one.document.configs.open_path(file)

    async def again(one: Opened) -> None:
        await until(lambda: one.state["path"] == str(file))
        await one.do(SetFixedFrame(frame="base"))
        await one.do(SaveRvizFile())
        assert "Fixed Frame: base" in file.read_text()

    async def linked(one: Opened) -> None:
        await until(lambda: one.state["path"] == str(file))
        file.unlink()
        file.symlink_to(file.with_name("other.rviz"))
        with pytest.raises(OutsideRootsError):
            await one.do(SaveRvizFile(replace=True))
        assert file.read_text() == FILE
        await one.do(CloseRvizConfig())

    async def closed(one: Opened) -> None:
        with pytest.raises(OutsideRootsError):
            await one.do(OpenRvizFile(path=str(file)))

    for work in (first, again, linked, closed):
        with_arm(folder, work)


def test_what_others_wrote_into_the_open_file_is_asked_about_before_it_is_lost(tmp_path: Path):
    file = tmp_path / "view.rviz"
    file.write_text(FILE)

    async def work(one: Opened) -> None:
        await one.do(OpenRvizFile(path="view.rviz"))
        file.write_text(FILE.replace("0.25", "0.75"))
        for path in ("", "view.rviz"):
            await one.do(SaveRvizFile(path=path))
            answer = one.ear.last("rviz_file_saved")
            assert (answer["is_there"], answer["changed"]) == (True, True)
        assert "0.75" in file.read_text()
        await one.do(SaveRvizFile(replace=True))
        assert file.read_text() == FILE
        await one.do(SaveRvizFile())
        answer = one.ear.last("rviz_file_saved")
        assert (answer["is_there"], answer["changed"]) == (False, False)
        (tmp_path / "other.rviz").write_text("")
        await one.do(SaveRvizFile(path="other.rviz"))
        answer = one.ear.last("rviz_file_saved")
        assert (answer["is_there"], answer["changed"]) == (True, False)
        file.unlink()
        await one.do(SaveRvizFile())
        assert file.read_text() == FILE

    with_arm(tmp_path, work)


REFUSED: tuple[tuple[Command, type[StudioError]], ...] = (
    (OpenRvizText(name="a.rviz", text="a: [1, 2"), RvizConfigError),
    (OpenRvizText(name="a.rviz", text="a: 1"), RvizConfigError),
    (OpenRvizFile(path="/etc/passwd"), OutsideRootsError),
    (OpenRvizFile(path="../../../etc/passwd"), OutsideRootsError),
    (OpenRvizFile(path="package://nowhere/view.rviz"), StudioError),
    (SaveRvizFile(path="/etc/view.rviz"), OutsideRootsError),
    (SaveRvizFile(path="nowhere/view.rviz"), StudioError),
    (SaveRvizFile(), CommandError),
)


def test_what_cannot_be_leaves_everything_as_it_was(tmp_path: Path):
    async def work(one: Opened) -> None:
        await one.do(OpenRvizText(name="first.rviz", text=FILE))
        before = one.document.live.kept
        for command, error in REFUSED:
            with pytest.raises(error):
                await one.do(command)
            assert one.document.live.kept == before
        assert one.state["undo"]

    with_arm(tmp_path, work)


def test_a_link_that_leads_out_is_not_read_and_who_presents_not_opens_no_file(tmp_path: Path):
    folder = tmp_path / "robot"
    folder.mkdir()
    secret = tmp_path / "secret.rviz"
    secret.write_text(FILE)
    (folder / "view.rviz").symlink_to(secret)

    async def work(one: Opened) -> None:
        with pytest.raises(OutsideRootsError):
            await one.do(OpenRvizFile(path="view.rviz"))
        with pytest.raises(NotAllowedError):
            await one.do(OpenRvizFile(path="arm.urdf"), Ear(Role.STUDENT))
        await one.do(OpenRvizText(name="own.rviz", text=FILE), Ear(Role.STUDENT))
        assert len(one.displays) == 3

    with_arm(folder, work)


def test_a_file_of_rviz_1_keeps_its_names_until_it_is_saved_for_rviz2(tmp_path: Path):
    text = FILE.replace("rviz_default_plugins/", "rviz/").replace("rviz_common/", "rviz/")

    async def work(one: Opened) -> None:
        await one.do(OpenRvizText(name="old.rviz", text=text))
        assert one.state["rviz1"]
        await one.do(GetRvizText())
        assert one.ear.last("rviz_text")["text"] == text
        await one.do(SaveRvizFile(path="new.rviz", rviz2=True))
        assert (one.state["name"], one.state["rviz1"]) == ("new.rviz", False)
        assert not one.state["changed"]
        written = (tmp_path / "new.rviz").read_text()
        assert "rviz/" not in written.replace("_rviz/", "")
        tree = yaml.safe_load(written)["Visualization Manager"]
        assert [each["Class"] for each in tree["Displays"]] == [
            "rviz_default_plugins/Grid", "rviz_common/Group",
        ]  # fmt: skip
        assert tree["Displays"][0]["Alpha"] == 0.25
        assert tree["Displays"][0]["Plane Cell Count"] == 10
        assert tree["Tools"][0]["Class"] == "rviz_default_plugins/MoveCamera"
        assert tree["Views"]["Current"]["Class"] == "rviz_default_plugins/Orbit"

    with_arm(tmp_path, work)


NAMING = """Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/RobotModel
      Description File: {}
      Description Source: File
      Name: Robot
      Value: true
"""


def test_a_robot_outside_the_folders_is_not_read_though_a_config_file_names_it(tmp_path: Path):
    folder = tmp_path / "robot"
    folder.mkdir()
    (tmp_path / "secret.urdf").write_text(ROBOT.replace("base", "secret_link"))

    def remarks(one: Opened) -> str:
        told = [each for each in one.ear.events if each["type"] == "display_states"]
        states: list[dict[str, Any]] = told[-1]["states"] if told else []
        return " ".join(each["sentence"] for state in states for each in state["remarks"])

    async def work(one: Opened) -> None:
        for name in (str(tmp_path / "secret.urdf"), "../secret.urdf", "package://../secret.urdf"):
            one.ear.events.clear()
            await one.do(OpenRvizText(name="a.rviz", text=NAMING.format(name)))
            await until(lambda: bool(remarks(one)) and "on its way" not in remarks(one))
            assert "secret_link" not in str(one.ear.events)

    with_arm(folder, work)


def test_a_page_begins_as_the_file_of_the_command_line_says(tmp_path: Path):
    """With its view; the first page of the owner with its panels, too."""
    file = tmp_path / "lab.studio.yaml"
    file.write_text(f"{FILE}Studio:\n  Version: 1\n  Plot span: 30\n")
    orbit = {"kind": "Orbit", "name": "Current View", "values": {"Distance": 3.0}}

    async def work(one: Opened) -> None:
        await one.document.configs.open_path(file)
        viewer = Ear(Role.STUDENT)
        for ear, page in ((viewer, ""), (one.ear, "Plot span"), (one.ear, "")):
            await one.do(GetRvizView(), ear)
            told = ear.last("rviz_view")
            assert told["view"] == orbit
            assert page in told["page"]
            assert bool(told["page"]) == bool(page)
        await one.do(CloseRvizConfig())
        await one.do(GetRvizView())
        assert one.ear.last("rviz_view")["view"] is None

    with_arm(tmp_path, work)


def test_the_file_is_named_at_once_when_the_robot_is_opened_again(tmp_path: Path):
    async def first(one: Opened) -> None:
        await one.do(OpenRvizText(name="arm.rviz", text=FILE))

    async def again(one: Opened) -> None:
        kind = "rviz_config_state"
        first = next(event for event in one.ear.events if event["type"] == kind)
        assert first["name"] == "arm.rviz"

    with_arm(tmp_path, first)
    with_arm(tmp_path, again)
