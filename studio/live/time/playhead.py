"""Playhead: where the time of a recording stands, and how it goes on."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Playhead:
    """A moment, and whether and how fast the time goes on from it.

    Attributes:
        at_ns: The moment, since the Unix epoch.
        playing: Whether the time goes on.
        rate: By how much it is faster than the wall's.
        loop: The part that is played again and again, begin and end; None: the whole, once.
    """

    at_ns: int
    playing: bool = False
    rate: float = 1.0
    loop: tuple[int, int] | None = None

    def advanced(self, elapsed_ns: int, begin_ns: int, end_ns: int) -> Playhead:
        """Return where it stands after a while: at the end it stops, or begins its loop again.

        Args:
            elapsed_ns: By the wall's clock.
            begin_ns: Of the recording.
            end_ns: Of the recording.
        """
        if not self.playing:
            return self
        at_ns = self.at_ns + round(elapsed_ns * self.rate)
        if self.loop is not None and at_ns > self.loop[1] >= self.at_ns:
            first_ns, last_ns = self.loop
            over_ns = (at_ns - last_ns) % max(1, last_ns - first_ns)
            return replace(self, at_ns=max(begin_ns, first_ns + over_ns))
        if at_ns >= end_ns:
            return replace(self, at_ns=max(self.at_ns, end_ns), playing=False)
        return replace(self, at_ns=at_ns)

    def started(self, begin_ns: int, end_ns: int) -> Playhead:
        """Return it going on; at the end it begins again."""
        if self.at_ns < end_ns or (self.loop is not None and self.at_ns <= self.loop[1]):
            return replace(self, playing=True)
        return replace(self, playing=True, at_ns=self.loop[0] if self.loop else begin_ns)

    def within(self, at_ns: int, begin_ns: int, end_ns: int) -> Playhead:
        """Return it at another moment, or at that end of the recording which is nearer."""
        return replace(self, at_ns=max(begin_ns, min(end_ns, at_ns)))
