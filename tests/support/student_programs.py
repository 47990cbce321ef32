"""Programs of users, run by `studio run` in a process of their own: they never share ours."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import Mapping

_ROOT: Final = Path(__file__).parents[2]


def studio_run(
    endpoint: str,
    *words: str,
    cwd: Path | None = None,
    environment: Mapping[str, str] | None = None,
) -> subprocess.CompletedProcess[str]:
    """`studio run WORDS` at a router; it must end in time."""
    return subprocess.run(
        [sys.executable, "-P", "-m", "studio", "run", *words],
        env=environment_at(endpoint) | dict(environment or {}),
        cwd=cwd,
        capture_output=True,
        text=True,
        errors="replace",
        timeout=PATIENCE_S,
        check=False,
    )


def environment_at(endpoint: str) -> dict[str, str]:
    """Return an environment in which nodes join a router, and this studio is found."""
    return {
        **os.environ,
        "PYTHONPATH": str(_ROOT),
        "ZENOH_CONFIG_OVERRIDE": f"connect/endpoints={json.dumps([endpoint])}",
        "PYTHONUNBUFFERED": "1",
    }


MANIFEST: Final = """\
<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>0.0.0</version><description>of a test</description>
  <maintainer email="a@example.com">a</maintainer><license>Apache-2.0</license>
  <depend>rclpy</depend>
  <export><build_type>ament_python</build_type></export>
</package>
"""
SETUP_CFG: Final = """\
[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""
SETUP_PY: Final = """\
import os
from glob import glob
from setuptools import setup

package_name = '{name}'

setup(
    name=package_name,
    packages=[package_name],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
        (os.path.join('share', package_name, 'launch'), glob('launch/*.py')),
        (os.path.join('share', package_name), glob('urdf/*')),
    ],
    entry_points={{
        'console_scripts': [
{scripts}
        ],
    }},
)
"""


def python_package(source: Path, name: str, modules: Mapping[str, str], *scripts: str) -> Path:
    """Write a package as `ros2 pkg create` lays it out, with modules and console scripts."""
    folder = source / name
    (folder / name).mkdir(parents=True)
    (folder / "resource").mkdir()
    (folder / "resource" / name).write_text("")
    (folder / name / "__init__.py").write_text("")
    for module, text in modules.items():
        (folder / name / f"{module}.py").write_text(text)
    lines = "\n".join(f"            {script!r}," for script in scripts)
    (folder / "package.xml").write_text(MANIFEST.format(name=name))
    (folder / "setup.cfg").write_text(SETUP_CFG.format(name=name))
    (folder / "setup.py").write_text(SETUP_PY.format(name=name, scripts=lines))
    return folder
