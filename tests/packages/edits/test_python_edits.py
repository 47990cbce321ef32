from __future__ import annotations

import pytest

from studio.packages.edits.python_edits import import_added
from studio.packages.sources.python_file import PythonFile
from studio.packages.sources.spans import with_replacements


@pytest.mark.parametrize(
    ("text", "line", "made"),
    [
        ('"""Doc."""\nimport rclpy\n', "import time", '"""Doc."""\nimport time\n\nimport rclpy\n'),
        ("import os\nx = 1\n", "import time", "import time\nimport os\nx = 1\n"),
        ("@a\ndef b(): pass\n", "import time", "import time\n\n\n@a\ndef b(): pass\n"),
        ("from . import a\n", "import rclpy", "import rclpy\nfrom . import a\n"),
        ("# only\n", "import time", "# only\n\nimport time\n"),
    ],
)
def test_an_import_stands_before_the_first_one_apart_from_other_groups(
    text: str, line: str, made: str
):
    change = import_added(PythonFile("a.py", text.encode()), line)
    assert with_replacements(text.encode(), [change]).decode() == made
