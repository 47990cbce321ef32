"""The room as a library: its face, what it needs, and the example of its README."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import studio.ros

ROOM = Path(studio.ros.__file__).parent
NEEDED = {"errors", "interfaces", "ros", "tf.rotations", "tf.transforms"}
ALL_MODULES = """
import importlib, pkgutil, sys
import studio.ros
assert "zenoh" not in sys.modules
for one in pkgutil.walk_packages(studio.ros.__path__, "studio.ros."):
    importlib.import_module(one.name)
print(*(name for name in sys.modules if name.startswith("studio.")))
"""


def ran(program: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True
    )
    return done.stdout


@pytest.mark.parametrize("name", studio.ros.__all__)
def test_each_name_of_the_face_is_there(name: str):
    assert getattr(studio.ros, name).__name__ == name


def test_another_name_is_no_attribute():
    assert not hasattr(studio.ros, "strange")


def test_it_needs_no_other_room_of_the_studio():
    loaded = {name.removeprefix("studio.") for name in ran(ALL_MODULES).split()}
    others = {
        name
        for name in loaded - {"tf"}
        if not any(name == needed or name.startswith(f"{needed}.") for needed in NEEDED)
    }
    assert not others


@pytest.mark.network
def test_the_nodes_of_the_readme_meet(endpoint: str):
    programs = re.findall(r"```python\n(.*?)```", (ROOM / "README.md").read_text(), re.DOTALL)
    environment = os.environ | {"ZENOH_CONFIG_OVERRIDE": f'connect/endpoints=["{endpoint}"]'}
    talker, listener = (
        subprocess.Popen(
            [sys.executable, "-c", program], env=environment, stderr=subprocess.PIPE, text=True
        )
        for program in programs
    )
    with talker, listener:
        try:
            assert listener.stderr is not None
            assert "I heard: hello" in listener.stderr.readline()
        finally:
            talker.kill()
            listener.kill()
