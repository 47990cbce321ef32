"""The room as a library: its face, what it needs, and the example of its README."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import studio.description

ROOM = Path(studio.description.__file__).parent
NEEDED = {
    "description", "errors", "files", "packages", "problems", "settings", "system", "workers",
    "worker_process",
}  # fmt: skip
ALL_MODULES = """
import importlib, pkgutil, sys
import studio.description
assert not [name for name in sys.modules if name.startswith("studio.description.")]
for one in pkgutil.walk_packages(studio.description.__path__, "studio.description."):
    importlib.import_module(one.name)
print(*(name for name in sys.modules if name.startswith("studio.")))
"""


def ran(program: str, folder: Path) -> str:
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return done.stdout


@pytest.mark.parametrize("name", studio.description.__all__)
def test_each_name_of_the_face_is_there(name: str):
    assert getattr(studio.description, name).__name__ == name


def test_another_name_is_no_attribute():
    assert not hasattr(studio.description, "strange")


def test_it_needs_no_other_room_of_the_studio(tmp_path: Path):
    rooms = {name.split(".")[1] for name in ran(ALL_MODULES, tmp_path).split()}
    assert rooms == NEEDED


def test_the_example_of_the_readme_prints_what_it_says(tmp_path: Path):
    blocks = re.findall(r"```(\w*)\n(.*?)```", (ROOM / "README.md").read_text(), re.DOTALL)
    (_, xacro), (_, program), (_, printed) = blocks
    (tmp_path / "cart.xacro").write_text(xacro)
    assert ran(program, tmp_path) == printed
    assert 'value="0.2"' in (tmp_path / "cart.xacro").read_text()
