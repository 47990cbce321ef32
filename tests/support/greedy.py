"""Programs that take more and more, and the limits that end them."""

from __future__ import annotations

from typing import Final

from studio.launch.watchdog import Limits

_MANY: Final = 100_000
CASES: Final = (
    (
        "import subprocess, time\n"
        "kept = [subprocess.Popen(['sleep', '100']) for _ in range(30)]\n"
        "time.sleep(100)\n",
        Limits(memory_bytes=1 << 40, processes=20, files=_MANY),
        "it has more than 20 processes",
    ),
    (
        "import time\nkept = b'x' * (700 << 20)\ntime.sleep(100)\n",
        Limits(memory_bytes=600 << 20, processes=_MANY, files=_MANY),
        "it takes more than 600 MB of memory",
    ),
    (
        "import os, time\n"
        "kept = [os.open(os.devnull, os.O_RDONLY) for _ in range(400)]\n"
        "time.sleep(100)\n",
        Limits(memory_bytes=1 << 40, processes=_MANY, files=300),
        "it has more than 300 files open",
    ),
)
"""Of each the code, limits, and the sentence's end."""
