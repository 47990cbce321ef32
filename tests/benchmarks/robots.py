"""The robots that are measured, and where to find them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class MeasuredRobot:
    """A robot file, its arguments, and a site whose edit moves or resizes something."""

    name: str
    file: Path
    arguments: tuple[str, ...] = ()
    site: str = ""
    """The end of a site's id or its name."""
    packages: Path | None = None

    def options(self) -> list[str]:
        """Arguments of `studio open`."""
        path = ["--package-path", str(self.packages)] if self.packages else []
        return [str(self.file), *self.arguments, *path]

    def mappings(self) -> dict[str, str]:
        """The xacro arguments by name."""
        return dict(word.split(":=", 1) for word in self.arguments)


def corpus() -> Path | None:
    """The public robots, where STUDIO_CORPUS says."""
    named = os.environ.get("STUDIO_CORPUS")
    return Path(named) if named and Path(named).is_dir() else None


def rover() -> MeasuredRobot:
    """The demo."""
    folder = REPOSITORY / "models" / "rover_description"
    return MeasuredRobot(
        "rover", folder / "urdf" / "rover.urdf.xacro", (), "wheel_radius", folder.parent
    )


def corpus_robots() -> list[MeasuredRobot]:
    """UR10e and PR2, when the corpus is there."""
    folder = corpus()
    if folder is None:
        return []
    ur = next(folder.rglob("ur_description/urdf/ur.urdf.xacro"), None) or next(
        folder.rglob("ur.urdf.xacro")
    )
    pr2 = next(folder.rglob("robots/pr2.urdf.xacro"))
    return [
        MeasuredRobot("UR10e", ur, ("ur_type:=ur10e", "name:=ur"), "kinematics.forearm.x", folder),
        MeasuredRobot("PR2", pr2, (), "shoulder_upper_arm_roll_offset", folder),
    ]
