"""The xacro worker: `python -m studio.description.worker` answers requests on its pipes."""

from __future__ import annotations

from studio.description.requests import CODEC
from studio.description.session import OpenSession
from studio.settings import XACRO_MEMORY_BYTES
from studio.worker_process import serve


def main() -> None:
    """Serve until the pipe closes."""
    serve(CODEC, OpenSession().answer, XACRO_MEMORY_BYTES)


if __name__ == "__main__":
    main()
