"""The xacro worker: `python -m studio.description.worker` answers requests on its pipes."""

from __future__ import annotations

import os
import sys

from studio.description.requests import CODEC, SHARED
from studio.description.session import OpenSession
from studio.settings import SHARED_MEMORY_BYTES, XACRO_MEMORY_BYTES
from studio.system import let_others_go_first
from studio.worker_process import serve


def main() -> None:
    """Serve until the pipe closes."""
    limit_bytes = XACRO_MEMORY_BYTES
    if SHARED in sys.argv[1:]:
        limit_bytes = SHARED_MEMORY_BYTES
        let_others_go_first(os.getpid())  # again: Linux refuses some of many at once
    serve(CODEC, OpenSession().answer, limit_bytes)


if __name__ == "__main__":
    main()
