"""How Python is started, and calls that not every system has, with what happens without them."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
import time
from pathlib import Path
from typing import IO, Final

PYTHON_OPTIONS: Final = ("-P", "-m")
"""The folder that we are in, which may be anybody's, gives no modules."""
_WATCH_INTERVAL_S = 0.2
_DESCRIPTORS = 16_384
_NICE = 10


def python_command(module: str, *arguments: str) -> tuple[str, ...]:
    """Return the command that runs a module by the Python that we run by."""
    return (sys.executable, *PYTHON_OPTIONS, module, *arguments)


def limit_memory(limit_bytes: int) -> None:
    """Bound this process's memory: by address space on Linux, by a watching thread elsewhere.

    Linux refuses the allocation (MemoryError); elsewhere the process ends with code 137.
    """
    if sys.platform == "linux":
        import resource  # noqa: PLC0415 - Unix only

        resource.setrlimit(resource.RLIMIT_AS, (limit_bytes, limit_bytes))
        return
    threading.Thread(target=_watch_memory, args=(limit_bytes,), daemon=True).start()


def _watch_memory(limit_bytes: int) -> None:
    """End the process when its peak resident size passes the limit."""
    try:
        import resource  # noqa: PLC0415 - Unix only
    except ImportError:  # Windows: the parent's time budget is the only bound
        return
    unit = 1 if sys.platform == "darwin" else 1024  # macOS counts bytes, the BSDs kilobytes
    while resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit < limit_bytes:
        time.sleep(_WATCH_INTERVAL_S)
    os._exit(137)


def is_running(pid: int) -> bool:
    """Whether a process of that number runs; True where that cannot be asked."""
    if sys.platform == "win32":
        return True  # to signal a process there ends it
    try:
        os.kill(pid, 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:  # it is another user's
        return True
    return True


def let_others_go_first(pid: int) -> None:
    """Have a process of ours take the processor only where nobody else wants it."""
    if sys.platform == "win32":
        return
    with contextlib.suppress(OSError):
        os.setpriority(os.PRIO_PROCESS, pid, _NICE)
    # Linux may weigh sessions against each other, and by this only the processes of one.
    with contextlib.suppress(OSError):
        Path(f"/proc/{pid}/autogroup").write_text(str(_NICE))


def raise_descriptor_limit() -> None:
    """Let this process open as many files and sockets as the system allows it: three a browser."""
    try:
        import resource  # noqa: PLC0415 - Unix only
    except ImportError:
        return
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = _DESCRIPTORS if most == resource.RLIM_INFINITY else min(most, _DESCRIPTORS)
    with contextlib.suppress(ValueError, OSError):
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, most))


def hold_file(path: Path) -> IO[bytes] | None:
    """Open a file and hold it until it is closed or this process ends; None: another holds it.

    Raises:
        OSError: It cannot be made or opened.
    """
    stream = path.open("ab")
    try:
        _lock(stream)
    except OSError:
        stream.close()
        return None
    return stream


def _lock(stream: IO[bytes]) -> None:
    """Raises OSError when another one, in this process or elsewhere, has it."""
    try:
        import fcntl  # noqa: PLC0415 - Unix only
    except ImportError:
        import msvcrt  # noqa: PLC0415 - Windows only

        stream.seek(0)
        msvcrt.locking(stream.fileno(), msvcrt.LK_NBLCK, 1)  # pyright: ignore
        return
    fcntl.flock(stream.fileno(), fcntl.LOCK_EX | fcntl.LOCK_NB)


def ignore_interrupt() -> None:
    """Leave Ctrl-C to the parent: a worker ends when its pipe closes."""
    import signal  # noqa: PLC0415 - keeps the import of this module cheap

    with contextlib.suppress(ValueError, AttributeError):
        signal.signal(signal.SIGINT, signal.SIG_IGN)
