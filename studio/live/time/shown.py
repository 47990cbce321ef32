"""ShownRecording: a recording that documents show, closed when the last one lets it go."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Literal

from studio.errors import RecordingError
from studio.live.time.ticks import RecordingTicks

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.bags.recording import Recording
    from studio.bags.series import RecordingSeries


class ShownRecording:
    """Thread-safe; whoever makes it holds it once.

    Attributes:
        recording: What is shown.
        title: Its name; of the last minutes none.
        path: Of its files, if it has any.
        mode: Whether it is a bag, or the last minutes of the live system.
        zero_ns: What the times of pages count from: its beginning, though that may be gone.
        ticks: Its errors and warnings.
        troubles: Sentences on what of it cannot be shown, for documents that it cannot serve.
    """

    def __init__(  # noqa: PLR0913 - the last minutes have their own zero and ticks
        self,
        recording: Recording,
        mode: Literal["past", "bag"],
        title: str = "",
        path: str = "",
        close: Callable[[], object] | None = None,
        *,
        zero_ns: int | None = None,
        ticks: RecordingTicks | None = None,
    ) -> None:
        self.recording, self.title, self.path = recording, title, path
        self.zero_ns = recording.begin_ns if zero_ns is None else zero_ns
        self.ticks = ticks or RecordingTicks(recording)
        self.mode: Literal["past", "bag"] = mode
        self.troubles: tuple[str, ...] = ()
        self._series: RecordingSeries | None = None
        self._close, self._holders = close, 1
        self._lock = threading.Lock()

    @property
    def series(self) -> RecordingSeries:
        """The numbers of its messages that are plotted.

        Raises:
            RecordingError: It was closed.
        """
        with self._lock:
            if not self._holders:
                raise RecordingError("The recording was closed.")
            if self._series is None:
                from studio.bags.series import RecordingSeries  # noqa: PLC0415 - takes its time

                self._series = RecordingSeries(self.recording)
            return self._series

    def hold(self) -> ShownRecording | None:
        """Hold it once more; None: it was closed meanwhile."""
        with self._lock:
            if not self._holders:
                return None
            self._holders += 1
        return self

    def let_go(self) -> None:
        """Hold it no more; its files are closed after the last one. In a thread."""
        with self._lock:
            self._holders -= 1
            if self._holders:
                return
        if self._series is not None:
            self._series.close()
        if self._close is not None:
            self._close()
