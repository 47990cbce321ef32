"""The recipes of CONTRIBUTING: how many files a new panel, display, command, verb or check takes.

Those that there are have the files of their recipe, and no other file names them.
"""

from __future__ import annotations

import json
import re
from collections import defaultdict
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from studio.cli.commands import summaries
from studio.displays.catalogue import DISPLAYS
from studio.documents.engine import COMMANDS
from studio.problems import whys
from studio.robot import checks as robot_checks
from tests.support.display_samples import SAMPLES

if TYPE_CHECKING:
    from studio.displays.display import Display

REPOSITORY = Path(__file__).resolve().parents[1]
ASSETS = REPOSITORY / "frontend_assets"
PANELS = sorted(path.parent.name for path in ASSETS.glob("panels/*/panel.json"))
COMMANDS_BY_NAME = {one.message.__name__: one for one in COMMANDS}
VERBS = sorted(summaries())
CHECKS = sorted(
    path.stem
    for path in (REPOSITORY / "studio/robot/checks").glob("*.py")
    if "\ndef findings(" in path.read_text(encoding="utf-8")
)
PACKAGE_CHECKS = sorted(
    path.stem
    for path in (REPOSITORY / "studio/packages/lint").glob("*.py")
    if "\ndef findings(" in path.read_text(encoding="utf-8")
)
IMPORT = re.compile(r"^ *from (studio[\w.]*) import (?:\(([^)]*)\)|(.+))$", re.MULTILINE)
FILES_MAX = {
    "panel": 9,
    "display": 4,
    "command": 2,
    "CLI verb": 2,
    "check of robots": 2,
    "check of packages": 2,
}
NAMES_OF_A_LIST = 3
"""Of panels: one or two words in a file may be other things, or panels that a button opens."""
DISPLAYS_NAMED = {
    ("studio/live/displays/marker_servers.py", "InteractiveMarkersDisplay"): "a client feeds it",
    ("studio/live/displays/robot_models.py", "RobotModelDisplay"): "its meshes are read there",
}
COMMANDS_PASSED_ON = {
    "AddDisplay": {"studio/live/displays/ghost.py"},
    # A relay does these by itself, and asks for what many follow once.
    "Watch": {"studio/server/relays/room.py"},
    "Follow": {
        "studio/server/relays/room.py",
        "studio/server/relays/origin_end.py",
        "studio/server/relays/standing.py",
    },
    "OpenLesson": {"studio/server/relays/standing.py"},
    "CloseLesson": {"studio/server/relays/standing.py"},
    "SawPanel": {"studio/server/relays/standing.py"},
    "FollowParameters": {"studio/server/relays/standing.py"},
    "FollowChanges": {"studio/server/relays/room.py", "studio/server/relays/origin_end.py"},
    "FollowOperations": {"studio/server/relays/room.py", "studio/server/relays/origin_end.py"},
    "AddToPackage": {"studio/live/programs/making.py"},
    "CreatePackage": {"studio/live/programs/making.py"},
    "GetGraph": {"studio/live/panels/recorded.py"},
    "GetNode": {"studio/live/panels/recorded.py"},
    "GetParameterNodes": {"studio/live/panels/recorded.py"},
    "GetParameters": {"studio/live/panels/recorded.py"},
    "GetTopicEnds": {"studio/live/panels/recorded.py"},
    "ListTopics": {"studio/live/panels/recorded.py"},
    "GetTf": {"studio/live/displays/scene_frames.py"},
    "InteractWithMarker": {"studio/live/displays/marker_servers.py"},
    "GetUrdf": {"studio/server/api.py"},
    "OpenFromWire": {
        "studio/live/connection/received_description.py",
        "studio/live/displays/robot_models.py",
    },
    "Publish": {"studio/live/panels/publication_work.py"},
    "RemoveDisplay": {"studio/live/displays/ghost.py"},
    "SendGoal": {"studio/live/panels/goal_work.py"},
    "SetDisplayProperty": {"studio/live/displays/ghost.py"},
}
"""Commands whose work a second file does, or that come by HTTP, too."""
VERBS_IMPORTED = {"demo": {"studio/cli/commands/open.py"}}
"""Without a file, `studio open` opens the demo."""


def section(part: str) -> str:
    """What CONTRIBUTING says of adding one."""
    text = (REPOSITORY / "CONTRIBUTING.md").read_text(encoding="utf-8")
    return text.partition(f"\n## Adding a {part}\n")[2].partition("\n## ")[0]


def recipe(part: str) -> list[str]:
    """The files that a new one takes, with `<id>` or the like in their names."""
    steps = re.findall(r"^\d+\. ((?:`[^`]+`(?:, )?)+):", section(part), re.MULTILINE)
    assert len(steps) == len(re.findall(r"^\d+\. ", section(part), re.MULTILINE)), part
    return [name for step in steps for name in re.findall(r"`([^`]+)`", step)]


def example(part: str) -> dict[str, str]:
    """The words in the names of the files of the one that a newcomer is to begin from."""
    found = re.search(r"\b[Bb]egin\s+from\s+`(\w+)`", section(part))
    assert found is not None
    if part != "command":
        return {"id": found[1], "name": found[1]}
    module = COMMANDS_BY_NAME[found[1]].message.__module__
    (doing,) = importers()[f"{module}.{found[1]}"]
    folder = Path(doing).relative_to("studio")
    subject = module.rpartition(".")[2]
    return {"subject": subject, "room": folder.parent.as_posix(), "part": folder.stem}


def filled(name: str, /, **words: str) -> Path:
    """A file of a recipe, of one that there is."""
    for word, value in words.items():
        name = name.replace(f"<{word}>", value)
    assert "<" not in name
    return REPOSITORY / name


@cache
def importers() -> dict[str, set[str]]:
    """Files of studio/ that import a name from a module of it, by `module.name`."""
    found: dict[str, set[str]] = defaultdict(set)
    for path in sources("studio"):
        for module, several, one in IMPORT.findall(text_of(path)):
            for name in re.findall(r"\w+(?: as \w+)?", several or one):
                found[f"{module}.{name.partition(' ')[0]}"].add(name_of(path))
    return found


def sources(folder: str) -> list[Path]:
    """All Python files below a folder."""
    return sorted((REPOSITORY / folder).rglob("*.py"))


def text_of(path: Path) -> str:
    return path.read_text(encoding="utf-8")


def name_of(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


@pytest.mark.parametrize("part", FILES_MAX)
def test_a_recipe_takes_so_many_files_at_most(part: str):
    files = recipe(part)
    assert 0 < len(files) == len(set(files)) <= FILES_MAX[part]


@pytest.mark.parametrize("part", FILES_MAX)
def test_the_example_of_a_recipe_is_made_of_its_files(part: str):
    for name in recipe(part):
        assert filled(name, **example(part)).is_file(), name


def test_the_example_of_a_panel_has_no_other_files():
    words = example("panel")
    named = {filled(name, **words) for name in recipe("panel")}
    assert set((ASSETS / "panels" / words["id"]).iterdir()) <= named


@pytest.mark.parametrize("panel", PANELS)
def test_a_panel_has_the_files_of_its_recipe(panel: str):
    # What several share has its styles and its way through the browser beside them.
    shared = (".css", ".test.js", "_panel.py")
    for name in recipe("panel"):
        assert name.endswith(shared) or filled(name, id=panel).is_file(), name
    words = json.loads((ASSETS / f"panels/{panel}/panel.json").read_text())["words"]
    assert set(words) == {"en", "de"}


def test_no_file_of_the_frame_lists_panels_or_has_the_path_of_one():
    frame = [*ASSETS.glob("*.html"), *ASSETS.glob("app/*.js"), *ASSETS.glob("styles/*.css")]
    lists: dict[str, set[str]] = {}
    paths: set[tuple[str, str]] = set()
    for path in frame:
        # An icon may have the name of a panel.
        text = re.sub(r"icon(=|: )\"\w+\"", "", text_of(path))
        named = {
            one for one in PANELS if re.search(rf"[\"'`]{one}[\"'`]|^ +{one}: \{{", text, re.M)
        }
        if len(named) >= NAMES_OF_A_LIST:
            lists[name_of(path)] = named
        paths |= {(name_of(path), one) for one in PANELS if f"panels/{one}/" in text}
    assert lists == {}
    # The 3D view comes with the page.
    assert paths == {("frontend_assets/app/panels.js", "scene")}


@pytest.mark.parametrize("display", DISPLAYS, ids=lambda one: one.KIND)
def test_a_display_has_the_files_of_its_recipe_and_no_others_name_it(display: type[Display]):
    module, name = display.__module__, display.__name__
    known = importers()[f"{module}.{name}"]
    assert "studio/displays/catalogue.py" in known
    elsewhere = {file for file in known if not file.startswith("studio/displays/")}
    assert elsewhere == {file for file, named in DISPLAYS_NAMED if named == name}
    assert any(sample.kind == display.KIND for sample in SAMPLES)
    assert list((REPOSITORY / "tests/displays").rglob(f"test_{module.rpartition('.')[2]}*.py"))


@pytest.mark.parametrize("name", COMMANDS_BY_NAME)
def test_a_command_is_named_by_its_message_and_by_the_file_that_does_the_work(name: str):
    entry = COMMANDS_BY_NAME[name]
    module = entry.message.__module__
    assert module.startswith("studio.protocol.")
    doing = importers()[f"{module}.{name}"] - COMMANDS_PASSED_ON.get(name, set())
    assert len(doing) == 1
    assert importers()[f"{module}.{name}"] >= COMMANDS_PASSED_ON.get(name, set())


def test_no_list_of_the_server_names_a_command_but_for_a_reason():
    # A word alone may be anything.
    types = [one.permission.name for one in COMMANDS if "_" in one.permission.name]
    texts = [text_of(path) for path in sources("studio/server")]
    named = {one for one in types if any(f'"{one}"' in text for text in texts)}
    assert named == {"get_urdf"}  # the robot can be downloaded, too


@pytest.mark.parametrize("verb", VERBS)
def test_a_verb_has_the_file_of_its_recipe_and_no_others_name_it(verb: str):
    file = filled(recipe("CLI verb")[0], name=verb)
    package = file.with_suffix("") / "__init__.py"
    assert file.is_file() or package.is_file()
    module = f"studio.cli.commands.{verb}"
    known = {
        one
        for name, files in importers().items()
        if name == module or name.startswith(f"{module}.")
        for one in files
        if not one.startswith(f"studio/cli/commands/{verb}")
    }
    assert known == VERBS_IMPORTED.get(verb, set())
    tests = [
        *(REPOSITORY / "tests").glob("test_cli*.py"),
        *(REPOSITORY / "tests/cli").rglob("*.py"),
    ]
    tests += [*(REPOSITORY / "tests/curriculum").glob("*.py")]
    assert any(re.search(rf'"{verb}\b', path.read_text(encoding="utf-8")) for path in tests)


@pytest.mark.parametrize("check", CHECKS)
def test_a_check_has_the_files_of_its_recipe_and_no_others_name_it(check: str):
    module = f"studio.robot.checks.{check}"
    assert not {one for name in importers() if name.startswith(module) for one in importers()[name]}
    assert list((REPOSITORY / "tests/robot/checks").glob(f"test_{check}*.py"))


@pytest.mark.parametrize("check", PACKAGE_CHECKS)
def test_a_check_of_packages_has_the_files_of_its_recipe_and_no_others_name_it(check: str):
    module = f"studio.packages.lint.{check}"
    assert not {one for name in importers() if name == module for one in importers()[name]}
    assert list((REPOSITORY / "tests/packages/lint").glob(f"test_{check}*.py"))


def test_no_other_file_names_the_code_of_a_finding_but_for_a_reason():
    own = {REPOSITORY / f"studio/robot/checks/{check}.py" for check in CHECKS}
    files = {*sources("studio"), *ASSETS.glob("*/*.js"), *ASSETS.glob("panels/*/*.js*")}
    codes = set(whys(robot_checks))
    found = {
        (name_of(path), code)
        for path in files - own
        for code in re.findall(
            r'"(?:why\.)?([a-z]+(?:-[a-z]+)+)"', path.read_text(encoding="utf-8")
        )
        if code in codes
    }
    # The tree of links marks one that has no mass.
    assert found == {("frontend_assets/lib/tree.js", "missing-inertial")}
