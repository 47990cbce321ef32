"""What every file and folder of the repository keeps to."""

from __future__ import annotations

import ast
import re
import subprocess
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
LINES_AT_MOST = 600
LONGER: dict[str, str] = {
    "studio/errors.py": "one tree of small classes, which a reader looks up by name",
}
"""Files that are longer, each with why it is one subject all the same."""
SMALL_FILES = {
    ".gitignore",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "LICENSE",
    "Makefile",
    "README.md",
    "constraints.txt",
    "pyproject.toml",
}
FOLDERS = {".ci", ".github", "frontend_assets", "models", "studio", "tests"}

# Built from pieces, so that this file does not hold what it looks for.
SHARED_FOLDER = "../" + "shared"
FORBIDDEN = {
    "a path of one machine": re.compile("/" + r"work/|/(home|Users)/\w+/"),
    "a package registry": re.compile(
        "|".join((r"pypi\.org", r"python" + r"hosted", r"npmjs\.", r"yarnpkg\.", r"npmmirror\."))
        + r"|\b(?:index-"
        + r"url|trusted-"
        + r"host)\b",
    ),
    "an address of a private network": re.compile(r"https?://(?:10|172|192\.168)\.\d"),
}
TEXT_SUFFIXES = {
    "", ".cfg", ".css", ".d.ts", ".html", ".js", ".json", ".md", ".mjs", ".py", ".rviz", ".toml",
    ".ts", ".txt", ".xacro", ".xml", ".yaml", ".yml",
}  # fmt: skip


def committed() -> list[Path]:
    """Every file that git holds, or in an unpacked source archive every file of our folders."""
    listed = subprocess.run(
        ["git", "-C", REPOSITORY, "ls-files", "-z"], capture_output=True, check=False
    )
    if listed.returncode == 0 and listed.stdout:
        paths = [REPOSITORY / name for name in listed.stdout.decode().split("\0") if name]
    else:
        roots = [REPOSITORY / name for name in FOLDERS]
        paths = [path for root in roots for path in root.rglob("*")]
        paths += [REPOSITORY / name for name in SMALL_FILES]
    skipped = {"node_modules", "__pycache__"}
    return sorted(path for path in paths if path.is_file() and not skipped & set(path.parts))


COMMITTED = committed()
ROOMS = sorted(
    path.parent
    for path in COMMITTED
    if path.match("studio/*/__init__.py") or path.match("studio/*/*/__init__.py")
)
SOURCES = [path for path in COMMITTED if path.suffix == ".py"]
PAGE_SOURCES = [
    path
    for path in COMMITTED
    if path.suffix in {".js", ".mjs", ".css"} and "vendor" not in path.parts
]


def name_of(path: Path) -> str:
    return path.relative_to(REPOSITORY).as_posix()


def texts() -> list[tuple[Path, str]]:
    found = [path for path in COMMITTED if path.suffix in TEXT_SUFFIXES]
    return [(path, path.read_text(encoding="utf-8", errors="replace")) for path in found]


def test_the_root_holds_the_five_folders_and_small_files_only():
    tops = {path.relative_to(REPOSITORY).parts[0] for path in COMMITTED}
    assert tops - SMALL_FILES == FOLDERS


@pytest.mark.parametrize("room", ROOMS, ids=name_of)
def test_a_room_says_what_flows_through_it(room: Path):
    docstring = ast.get_docstring(ast.parse((room / "__init__.py").read_text()))
    assert docstring, f"{name_of(room)} has no docstring"
    assert len(docstring.split()) >= 5


def test_the_long_files_are_those_that_have_a_reason():
    long = {
        name_of(path)
        for path in (*SOURCES, *PAGE_SOURCES)
        if len(path.read_text(encoding="utf-8").splitlines()) > LINES_AT_MOST
    }
    assert long == set(LONGER)
    assert all(LONGER.values())


@pytest.mark.parametrize("what", FORBIDDEN)
def test_no_committed_file_names(what: str):
    pattern = FORBIDDEN[what]
    bad = [f"{name_of(path)}: {m[0]}" for path, text in texts() if (m := pattern.search(text))]
    assert not bad


def test_only_the_ci_script_knows_where_the_corpus_lies():
    naming = {name_of(path) for path, text in texts() if SHARED_FOLDER in text}
    assert naming == {".ci/run"}


def test_pins_are_names_and_versions_only():
    lines = (REPOSITORY / "constraints.txt").read_text().splitlines()
    assert lines
    assert all(re.fullmatch(r"[A-Za-z0-9._-]+==[A-Za-z0-9.!+_-]+", line) for line in lines)


def test_every_requirement_is_pinned():
    import tomllib

    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["project"]
    extras = [one for group in project["optional-dependencies"].values() for one in group]
    wanted = {
        re.split(r"[\[<>=;~! ]", one)[0].lower().replace("_", "-")
        for one in [*project["dependencies"], *extras]
    }
    pinned = {
        line.split("==")[0].lower().replace("_", "-")
        for line in (REPOSITORY / "constraints.txt").read_text().splitlines()
    }
    assert wanted <= pinned


# Folders of tests that go through several rooms, and tests of a room as a whole.
ACROSS_ROOMS = {
    "bad_input",
    "benchmarks",
    "browser",
    "contract",
    "corpus",
    "curriculum",
    "faults",
    "models",
}
OF_A_WHOLE_ROOM = {
    "test_browser_camera.py",
    "test_browser_opening.py",
    "test_browser_view.py",
    "test_comments.py",
    "test_corpus.py",
    "test_expanded_as_stock.py",
    "test_hostile_bombs.py",
    "test_hostile_code.py",
    "test_hostile_input.py",
    "test_hostile_texts.py",
    "test_warnings.py",
}


TESTS_OF_ROOMS = [
    p for p in SOURCES if p.match("tests/*/test_*.py") or p.match("tests/*/*/test_*.py")
]


def test_every_test_file_mirrors_a_source_file():
    assert [name_of(path) for path in TESTS_OF_ROOMS if not _mirrors_a_source(path)] == []


def _mirrors_a_source(path: Path) -> bool:
    room = path.parent.relative_to(REPOSITORY / "tests")
    if room.parts[0] in ACROSS_ROOMS or path.name in OF_A_WHOLE_ROOM:
        return True
    # Of a file with several tests: test_<file>_<what of it>.py
    name = path.stem.removeprefix("test_")
    folder = REPOSITORY / "studio" / room
    files = [name[:end] for end in (len(name), *(m.start() for m in re.finditer("_", name)))]
    return any((folder / f"{file}.py").is_file() for file in files) or name == folder.name
