"""The page in a wheel: its own modules as the server sends them, without comments and indentation.

Half of what these modules hold is said to who works on them, with types; a wheel is for who runs
them. An editable install has them as written.
"""

from __future__ import annotations

import re
import runpy
import shutil
import tempfile
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_OWN_MODULE = re.compile(r"studio/_frontend_assets/(?!vendor/).*\.js$")


class BarePage(BuildHookInterface[Any]):
    """Puts the page's modules into the wheel through a folder of its own."""

    _made: Path | None = None

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Write each module that the wheel would hold, and have it taken instead."""
        if version == "editable":
            return
        # By its path: to import its package would need what the studio runs on.
        bare = runpy.run_path(str(Path(self.root, "studio/server/modules.py")))["bare"]
        self._made = Path(tempfile.mkdtemp())
        for file in self.build_config.builder.recurse_selected_project_files():
            name = file.distribution_path
            if not _OWN_MODULE.match(name):
                continue
            made = self._made / name
            made.parent.mkdir(parents=True, exist_ok=True)
            made.write_text(bare(Path(file.path).read_text(encoding="utf-8")), encoding="utf-8")
            build_data["force_include"][str(made)] = name

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove that folder."""
        if self._made is not None:
            shutil.rmtree(self._made)
