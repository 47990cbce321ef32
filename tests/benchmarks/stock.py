"""Stock xacro as the peer: the command, and the library in this process."""

# pyright: reportPrivateUsage=false, reportUnknownMemberType=false, reportUnknownVariableType=false
from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast
from unittest.mock import patch

import xacro
from xacro import substitution_args

from tests.support.descriptions import packages_below
from tests.support.stock_command import StockCommand

if TYPE_CHECKING:
    from pathlib import Path

    from tests.benchmarks.robots import MeasuredRobot


class Stock:
    """Expands one robot the two ways that there are without the studio."""

    def __init__(self, robot: MeasuredRobot, scratch: Path) -> None:
        packages = packages_below(robot.packages or robot.file.parent)
        self._robot, self._packages = robot, packages
        folder = scratch / "stock"
        folder.mkdir()
        self._command = StockCommand(folder, packages)

    def by_command(self) -> None:
        """What a person types: `xacro FILE name:=value ...`."""
        self._command.run(str(self._robot.file), *self._robot.arguments)

    def in_process(self) -> None:
        """Without starting Python; the document as text, as robot_state_publisher gets it."""

        def find(name: str) -> str:
            return self._packages[name][0]

        table = cast("dict[str, Any]", substitution_args._eval_dict)
        with (
            patch.object(substitution_args, "_eval_find", find),
            patch.dict(table, {"find": find}),
        ):
            mappings = self._robot.mappings()
            document = cast("Any", xacro.process_file(str(self._robot.file), mappings=mappings))
            document.toprettyxml(indent="  ")
