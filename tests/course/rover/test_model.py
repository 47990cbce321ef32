from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.course.rover.model import model_file, urdf_of
from studio.errors import DescriptionError

if TYPE_CHECKING:
    from pathlib import Path


def test_the_model_is_expanded_with_its_arguments():
    assert 'name="arm_roll_joint"' in urdf_of(model_file(), {})
    assert 'name="arm_roll_joint"' not in urdf_of(model_file(), {"arm": "false"})


def test_a_model_reads_nothing_outside_its_package(tmp_path: Path):
    secret = tmp_path / "secret.yaml"
    secret.write_text("a: 1")
    folder = tmp_path / "rover_description" / "urdf"
    folder.mkdir(parents=True)
    entry = folder / "rover.urdf.xacro"
    entry.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        f"<link name=\"l${{xacro.load_yaml('{secret}')['a']}}\"/></robot>"
    )
    with pytest.raises(DescriptionError):
        urdf_of(entry, {})
