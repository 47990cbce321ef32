"""Plans every launch file below a folder, and counts: `python -m tests.support.launch_sweep`.

Without a folder that of STUDIO_CORPUS. A file counts as planned where its plan is whole and nothing
of it failed but what lies outside of it: a package that is not there, or an argument without a
value. Launch files of ROS 1 are counted apart: ROS 2 refuses them, too.
"""

from __future__ import annotations

import os
import re
import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from studio.launch.finding import launch_files
from studio.launch.planning import PlanLimits, plan_launch_file
from tests.support.launch_files import index_of

if TYPE_CHECKING:
    from studio.launch.plan import Plan
    from studio.packages.index import PackageIndex

_LIMITS = PlanLimits(seconds=60.0)
_OUTSIDE = (
    ("package '", "a package is not there"),
    ('package "', "a package is not there"),
    ("is not installed, so ROS", "a file is not installed"),
    ("environment variable '", "a variable of the environment is not set"),
    ("cannot be read (No such file", "a file that it names is not there"),
    ("which file depends on an argument", "an argument without a value names a file"),
)
_OF_ROS_1 = re.compile(rb"\$\(find |\$\(arg |<node[^>]*\btype=|<rosparam|\$\(optenv ")


@dataclass
class Swept:
    """What came of the launch files."""

    planned: list[Path] = field(default_factory=list[Path])
    outside: dict[Path, str] = field(default_factory=dict[Path, str])
    failed: dict[Path, str] = field(default_factory=dict[Path, str])
    of_ros_1: list[Path] = field(default_factory=list[Path])
    unsupported: Counter[str] = field(default_factory=Counter[str])
    nodes: Counter[str] = field(default_factory=Counter[str])

    @property
    def share(self) -> float:
        """How many of the ROS 2 files are planned, what lies outside of them left aside."""
        count = len(self.planned) + len(self.outside) + len(self.failed)
        return 1.0 if not count else (len(self.planned) + len(self.outside)) / count


def sweep(folder: Path) -> Swept:
    """Plan each launch file below a folder."""
    swept, index = Swept(), index_of(folder)
    for file in launch_files(folder):
        if _is_of_ros_1(file):
            swept.of_ros_1.append(file)
        else:
            _take(swept, file, _plan(file, index))
    return swept


def _plan(file: Path, index: PackageIndex) -> Plan:
    return plan_launch_file(file, {}, index, _LIMITS)


def _is_of_ros_1(file: Path) -> bool:
    return not file.name.endswith((".py", ".yaml")) and bool(_OF_ROS_1.search(file.read_bytes()))


def _take(swept: Swept, file: Path, plan: Plan) -> None:
    for row in plan.unsupported:
        swept.unsupported[row.name] += 1
    for node in plan.nodes:
        swept.nodes[node.start.kind] += 1
    reasons = [_reason(one.sentence) for one in plan.failures]
    own = [text for is_outside, text in reasons if not is_outside]
    if own:
        swept.failed[file] = own[0]
    elif reasons:
        swept.outside[file] = reasons[0][1]
    else:
        swept.planned.append(file)


def _reason(sentence: str) -> tuple[bool, str]:
    for part, reason in _OUTSIDE:
        if part in sentence:
            return True, reason
    return False, sentence


def report(swept: Swept, folder: Path) -> str:
    """Return what came of it, a line for each count and reason."""
    lines = [
        f"planned whole      {len(swept.planned)}",
        f"planned, but       {len(swept.outside)}",
        *(f"    {n:4} {reason}" for reason, n in Counter(swept.outside.values()).most_common()),
        f"not planned        {len(swept.failed)}",
        *(f"    {file.relative_to(folder)}: {why[:200]}" for file, why in swept.failed.items()),
        f"of ROS 1           {len(swept.of_ros_1)}",
        f"share of ROS 2's   {swept.share:.1%}",
        f"nodes by start     {dict(swept.nodes)}",
        *(f"    not supported: {n:3} {name}" for name, n in swept.unsupported.most_common(30)),
    ]
    return "\n".join(lines) + "\n"


def main() -> None:
    """Sweep and print."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else os.environ["STUDIO_CORPUS"]).resolve()
    sys.stdout.write(report(sweep(folder), folder))


if __name__ == "__main__":
    main()
