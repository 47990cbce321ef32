from __future__ import annotations

import os
from typing import TYPE_CHECKING

from studio.launch.reporting import Lines

if TYPE_CHECKING:
    import pytest


def test_who_reads_no_more_does_not_keep_a_launch_from_its_end(monkeypatch: pytest.MonkeyPatch):
    end, begin = os.pipe()
    os.close(end)
    with os.fdopen(begin, "w") as unread:
        monkeypatch.setattr("sys.stdout", unread)
        lines = Lines()
        lines.log("warn", "user interrupted")
        lines.log("info", "and more")
