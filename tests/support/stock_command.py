"""The `xacro` command itself, in a process of its own, with packages found without ROS."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_INDEX = """
import json, os
def get_package_share_directory(name):
    with open(os.environ["STUDIO_TEST_PACKAGE_MAP"]) as file:
        return json.load(file)[name][0]
"""
_BATCH = """
import contextlib, io, json, sys
import xacro
texts = []
for path, mappings in json.load(sys.stdin):
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
        try:
            xacro._process(path, dict(output=None, just_deps=False, verbosity=1, mappings=mappings))
            texts.append(out.getvalue())
        except (SystemExit, Exception):
            texts.append(None)
json.dump(texts, sys.stdout)
"""


class StockCommand:
    """Runs bare xacro; `scratch` is an empty folder for the stand-in of ROS's package index."""

    def __init__(self, scratch: Path, packages: Mapping[str, Sequence[str]]) -> None:
        module = scratch / "ament_index_python"
        module.mkdir()
        (module / "__init__.py").write_text("")
        (module / "packages.py").write_text(_INDEX)
        self._batch = scratch / "batch.py"
        self._batch.write_text(_BATCH)
        (scratch / "packages.json").write_text(json.dumps(packages))
        self._environment = {
            **os.environ,
            "PYTHONPATH": str(scratch),
            "STUDIO_TEST_PACKAGE_MAP": str(scratch / "packages.json"),
        }

    def run(self, file: str, *arguments: str) -> str:
        """What `xacro FILE name:=value ...` prints; CalledProcessError when it fails."""
        command = [str(Path(sys.executable).with_name("xacro")), file, *arguments]
        return self._run(command, None)

    def batch(self, files: Sequence[str]) -> dict[str, str | None]:
        """What the command prints for each of many files in one process, None where it fails.

        Files that print sets, whose order changes from process to process, are left out.
        """
        told = json.dumps([(file, {}) for file in files])
        once, again = (self._batch_in(told, seed) for seed in "12")
        both = zip(files, once, again, strict=True)
        return {file: text for file, text, other in both if text == other}

    def batch_with(self, launches: Sequence[tuple[str, Mapping[str, str]]]) -> list[str | None]:
        """What it prints for each file with its arguments, None where it fails."""
        return self._batch_in(json.dumps(launches), "1")

    def _batch_in(self, told: str, seed: str) -> list[str | None]:
        command = [sys.executable, str(self._batch)]
        return json.loads(self._run(command, told, {"PYTHONHASHSEED": seed}))

    def _run(
        self, command: list[str], told: str | None, also: Mapping[str, str] | None = None
    ) -> str:
        return subprocess.run(
            command,
            env={**self._environment, **(also or {})},
            input=told,
            capture_output=True,
            text=True,
            check=True,
        ).stdout
