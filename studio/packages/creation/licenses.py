"""The licences that a new package can get by name, and their texts."""

from __future__ import annotations

from pathlib import Path
from typing import Final

_FOLDER: Final = Path(__file__).parent / "licenses"
LICENSES: Final = (
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "GPL-3.0-only",
    "LGPL-3.0-only",
    "MIT",
    "MIT-0",
)
"""By their SPDX names, which `ros2 pkg create` takes, too."""
SHORT: Final = frozenset({"GPL-3.0-only", "LGPL-3.0-only"})
"""Of these the notice is written, with the address of the whole text."""
_ALIASES: Final = {
    "apache2": "Apache-2.0",
    "apache-2": "Apache-2.0",
    "apache 2.0": "Apache-2.0",
    "apache license 2.0": "Apache-2.0",
    "bsd": "BSD-3-Clause",
    "bsd3": "BSD-3-Clause",
    "bsd2": "BSD-2-Clause",
    "bsd-2.0": "BSD-2-Clause",
    "boost1": "BSL-1.0",
    "gplv3": "GPL-3.0-only",
    "gpl-3.0": "GPL-3.0-only",
    "lgplv3": "LGPL-3.0-only",
    "lgpl-3.0": "LGPL-3.0-only",
}


def known_license(name: str) -> str:
    """Return the SPDX name of a licence that has a text here; empty if it has none."""
    lowered = name.strip().lower()
    by_name = {one.lower(): one for one in LICENSES}
    return by_name.get(lowered) or _ALIASES.get(lowered, "")


def license_text(name: str, holder: str, year: int) -> str:
    """Return the text of one of `LICENSES`."""
    text = (_FOLDER / f"{name}.txt").read_text(encoding="utf-8")
    return text.replace("@YEAR@", str(year)).replace("@HOLDER@", holder)
