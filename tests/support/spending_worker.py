"""A worker that works, or sleeps, for as long as it is asked to."""

from __future__ import annotations

import time
from dataclasses import dataclass

from studio.worker_process import Codec, serve


@dataclass(frozen=True)
class Spend:
    """Seconds of the processor, then seconds of sleep."""

    working_s: float = 0.0
    sleeping_s: float = 0.0


@dataclass(frozen=True)
class Spent:
    """All of it was spent."""


CODEC = Codec(Spend, Spent)


def spend(request: Spend) -> Spent:
    """Do as asked."""
    end_s = time.process_time() + request.working_s
    while time.process_time() < end_s:
        pass
    time.sleep(request.sleeping_s)
    return Spent()


if __name__ == "__main__":
    serve(CODEC, spend, 1 << 30)
