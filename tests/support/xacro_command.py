"""The stock `xacro` command, without ROS: `$(find)` is answered from folders of packages."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

_INDEX = """
class PackageNotFoundError(KeyError):
    pass

def get_package_share_directory(name):
    import os
    for folder in os.environ["STUDIO_TEST_PACKAGES"].split(os.pathsep):
        if os.path.isfile(os.path.join(folder, name, "package.xml")):
            return os.path.join(folder, name)
    raise PackageNotFoundError(name)
"""


def expand_by_command(file: Path, packages: Path, scratch: Path, *arguments: str) -> str:
    """What `xacro FILE name:=value ...` prints.

    Args:
        file: The entry point.
        packages: A folder of packages for `$(find)`.
        scratch: An empty folder, for the stand-in of ROS's package index.
        arguments: `name:=value` each.

    Raises:
        subprocess.CalledProcessError: It failed; `stderr` says why.
    """
    module = scratch / "ament_index_python"
    module.mkdir(exist_ok=True)
    (module / "__init__.py").write_text("")
    (module / "packages.py").write_text(_INDEX)
    command = Path(sys.executable).with_name("xacro")
    environment = {
        **os.environ,
        "PYTHONPATH": str(scratch),
        "STUDIO_TEST_PACKAGES": str(packages),
    }
    answer = subprocess.run(
        [command, file, *arguments], env=environment, capture_output=True, text=True, check=True
    )
    assert not answer.stderr, answer.stderr
    return answer.stdout
