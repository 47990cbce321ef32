"""What of each `.rviz` file of the corpus is only kept: `python -m tests.support.rviz_losses`.

Writes the list that `tests/rviz/test_config.py` holds the studio to: read what it changes before it
is committed.
"""

from __future__ import annotations

import json
from pathlib import Path

from studio.rviz.config import read_config
from tests.support.corpus import corpus

LOSSES = Path(__file__).resolve().parents[1] / "rviz" / "rviz_losses.json"
"""By file: reason, class or part, properties."""


def listed() -> dict[str, list[list[object]]]:
    """What is lost of each file now."""
    return {
        str(file.relative_to(corpus())): [
            [one.reason, one.what, list(one.names)] for one in read_config(file.read_text())[1]
        ]
        for file in sorted(corpus().rglob("*.rviz"))
    }


def main() -> None:
    """Write the list, a line for each loss."""
    files = (
        f" {json.dumps(name)}: [\n" + ",\n".join(f"  {json.dumps(one)}" for one in losses) + "\n ]"
        for name, losses in listed().items()
    )
    LOSSES.write_text("{\n" + ",\n".join(files) + "\n}\n")


if __name__ == "__main__":
    main()
