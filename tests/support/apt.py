"""Debian's packages for tests: what a machine lacks is installed, if it may be."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys


def install_by_apt(*names: str) -> None:
    """Install the first of these packages that there is; needs root and apt, else does nothing."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or not shutil.which("apt-get"):
        return
    quiet = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}

    def apt(*command: str) -> bool:
        done = subprocess.run(
            ["apt-get", "-q", *command], env=quiet, stdout=sys.stderr, timeout=600, check=False
        )
        return done.returncode == 0

    apt("update")
    any(apt("install", "-y", "--no-install-recommends", name) for name in names)
