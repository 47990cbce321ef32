"""Zenoh's threads: fewer that hand samples to one another take a third less to receive them."""

from __future__ import annotations

import os
from typing import Final

_VARIABLE: Final = "ZENOH_RUNTIME"
_FEW: Final = "(rx: (handover: app), app: (worker_threads: 1))"


def take_few_threads() -> None:
    """Have one thread of Zenoh's receive all; call it before anything of Zenoh's is opened.

    Of its own accord it takes two for what comes in, which wake each other for every sample.
    Whoever sets the variable for this process, or opened something before, is not overruled.
    """
    os.environ.setdefault(_VARIABLE, _FEW)
