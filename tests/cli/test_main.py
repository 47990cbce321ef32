from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

FULL = Path("/dev/full")
LISTING = [sys.executable, "-m", "studio", "interface", "list", "-a"]


def test_letters_that_the_output_cannot_hold_are_written_as_escapes():
    text = b"MSG: own_interfaces/Cell\n# \xc3\xbcber \xff\nfloat32 x\n"
    words = [sys.executable, "-m", "studio", "interface", "show", "own_interfaces/msg/Cell",
             "--interfaces", "-"]  # fmt: skip
    plain = {**os.environ, "PYTHONIOENCODING": "ascii"}
    ran = subprocess.run(words, input=text, capture_output=True, env=plain, check=True)
    assert ran.stdout == b"# \\ufffd\\ufffdber \\ufffd\nfloat32 x\n"
    ran = subprocess.run(
        words,
        input=text,
        capture_output=True,
        env={**plain, "PYTHONIOENCODING": "utf-8"},
        check=True,
    )
    assert ran.stdout.decode() == "# über \ufffd\nfloat32 x\n"


@pytest.mark.skipif(not FULL.exists(), reason="there is no /dev/full on this system")
def test_a_full_disk_is_one_sentence():
    with FULL.open("w") as full:
        ran = subprocess.run(LISTING, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert ran.returncode == 2
    assert ran.stderr == "studio: The output cannot be written: No space left on device.\n"


def test_a_reader_that_goes_away_is_no_fault():
    with subprocess.Popen(
        LISTING, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as ran:
        assert ran.stdout is not None
        ran.stdout.close()
        assert ran.stderr is not None
        assert ran.stderr.read() == ""
        assert ran.wait() == 0
