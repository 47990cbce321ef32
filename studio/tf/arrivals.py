"""Arrivals: when transforms of each frame came and from whom, by the clock of this machine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from studio.tf.forest import NONE
from studio.tf.histories import grown

if TYPE_CHECKING:
    from studio.tf.transforms import Flags, Floats, Numbers

_KEPT: Final = 64
WINDOW_NS: Final = 10_000_000_000
_PAUSES: Final = 16
_STALE_AFTER_PAUSES: Final = 3
_STALE_AT_LEAST_NS: Final = 1_000_000_000
_PUBLISHERS_MAX: Final = 4096


class Arrivals:
    """By frame: its last arrivals, the publisher of its newest pose, and another publisher."""

    def __init__(self) -> None:
        self._times_ns = np.zeros((0, _KEPT), np.int64)
        self._count = np.zeros(0, np.int64)
        self._publisher = np.zeros(0, np.int64)
        self._other = np.zeros(0, np.int64)
        self._other_ns = np.zeros(0, np.int64)
        self._publishers: dict[str, int] = {"": 0}
        self._names: dict[int, str] = {0: ""}
        self._newest = 0

    def fit(self, count: int) -> None:
        """Make room for frames of numbers below this."""
        if count > len(self._count):
            for name in ("_times_ns", "_count", "_publisher", "_other", "_other_ns"):
                setattr(self, name, grown(getattr(self, name), count))

    def publisher(self, name: str) -> int:
        """Return the number of a publisher, a new one if needed."""
        number = self._publishers.get(name)
        if number is None:
            if len(self._publishers) >= _PUBLISHERS_MAX:
                self._forget_publishers()
            self._newest += 1
            number = self._publishers[name] = self._newest
            self._names[number] = name
        return number

    def note(self, frames: Numbers, publisher: int, now_ns: int) -> None:
        """Note the newest transforms of frames, each named once."""
        publishers = self._publisher[frames]
        changed = publishers != publisher
        if changed.any():
            to = frames[changed & (self._count[frames] > 0)]
            self._other[to], self._other_ns[to] = self._publisher[to], self._last_ns(to)
            self._publisher[frames] = publisher
        self._times_ns[frames, self._count[frames] % _KEPT] = now_ns
        self._count[frames] += 1

    def note_older(self, frame: int, publisher: int, now_ns: int) -> None:
        """Note a transform that is older than the newest, whose publisher stays the frame's."""
        if publisher != self._publisher[frame]:
            self._other[frame], self._other_ns[frame] = publisher, now_ns
        self._times_ns[frame, self._count[frame] % _KEPT] = now_ns
        self._count[frame] += 1

    def clear(self, frame: int | Numbers) -> None:
        """Forget a frame, or several."""
        for one in (self._count, self._publisher, self._other, self._other_ns):
            one[frame] = 0

    def last_ns(self, frame: int) -> int:
        """Return when the last transform of a frame came."""
        return int(self._times_ns[frame, (self._count[frame] - 1) % _KEPT])

    def ages_s(self, frames: Numbers, now_ns: int) -> Floats:
        """Return the time since the last transform of each, shape (N,); 0 where none ever came."""
        known = self._count[frames] > 0
        return np.where(known, np.maximum(now_ns - self._last_ns(frames), 0) / 1e9, 0.0)

    def publisher_number(self, frame: int) -> int:
        """Return the number of the publisher of the newest of a frame."""
        return int(self._publisher[frame])

    def frames_of(self, publisher: int) -> list[int]:
        """Return the frames whose newest transform is of a publisher."""
        return np.flatnonzero((self._publisher == publisher) & (self._count > 0)).tolist()

    def publishers_of(self, frame: int, now_ns: int) -> tuple[str, ...]:
        """Return the publisher of the newest of a frame, and another of the last seconds."""
        publisher, other = int(self._publisher[frame]), int(self._other[frame])
        other_ns = int(self._other_ns[frame])
        names = [self._name(publisher)]
        if other_ns and now_ns - other_ns <= WINDOW_NS and other != publisher:
            names.append(self._name(other))
        return tuple(names)

    def rates_hz(self, frames: Numbers, now_ns: int) -> Floats:
        """Return the rate of each, over the last 64 arrivals within 10 s; 0 when it is not known.

        A frame that is silent for longer than its mean period gets slower from then on.
        """
        times_ns, known = self._lately(frames, _KEPT)
        counts = np.count_nonzero(known & (times_ns > now_ns - WINDOW_NS), axis=1)
        first_ns = times_ns[np.arange(len(frames)), np.maximum(counts - 1, 0)]
        span_ns = times_ns[:, 0] - first_ns
        known_twice = (counts > 1) & (span_ns > 0)
        lately = (counts - 1) / np.where(known_twice, span_ns, 1)
        until_now = counts / np.maximum(now_ns - first_ns, 1)
        return np.where(known_twice, np.minimum(lately, until_now) * 1e9, 0.0)

    def are_stale(self, frames: Numbers, now_ns: int) -> Flags:
        """Return which have been silent for 3 of their longer pauses, and for a second at least."""
        times_ns, known = self._lately(frames, _PAUSES + 1)
        silent_ns = np.where(known[:, 0], now_ns - times_ns[:, 0], WINDOW_NS)
        pauses_ns = np.where(known[:, 1:], times_ns[:, :-1] - times_ns[:, 1:], NONE)
        # The longest may be from when its publisher was away; a single pause is all there is.
        pauses_ns.partition((-2, -1), axis=1)
        usual_ns = np.where(pauses_ns[:, -2] == NONE, pauses_ns[:, -1], pauses_ns[:, -2])
        after_ns = np.maximum(_STALE_AT_LEAST_NS, _STALE_AFTER_PAUSES * usual_ns)
        return np.where(known[:, 1], silent_ns > after_ns, silent_ns >= WINDOW_NS)

    def _lately(self, frames: Numbers, most: int) -> tuple[Numbers, Flags]:
        """Return the last arrivals of each, newest first, shape (N, most), and which are valid."""
        back, counts = np.arange(most), self._count[frames, None]
        return self._times_ns[frames[:, None], (counts - 1 - back) % _KEPT], back < counts

    def _last_ns(self, frames: Numbers) -> Numbers:
        return self._times_ns[frames, (self._count[frames] - 1) % _KEPT]

    def _forget_publishers(self) -> None:
        """Keep those that publish a frame now."""
        used = {0, *self._publisher.tolist(), *self._other.tolist()}
        self._publishers = {
            name: number for name, number in self._publishers.items() if number in used
        }
        self._names = {number: name for name, number in self._publishers.items()}

    def _name(self, publisher: int) -> str:
        return self._names.get(publisher, "")
