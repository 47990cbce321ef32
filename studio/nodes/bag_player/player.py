"""BagPlayer: plays a recording onto topics, in step with the steady clock."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.bags.recording import Recorded
from studio.errors import BagError, DestroyedError
from studio.nodes.bag_player.offers import full_names, learn_types, open_offers
from studio.nodes.bag_player.pace import Pace
from studio.nodes.bag_player.read_ahead import ReadAhead
from studio.nodes.bag_player.split_events import SplitEvents
from studio.ros.condition import Condition
from studio.ros.duration import NANOSECONDS
from studio.ros.node.clock import CLOCK_QOS, CLOCK_TOPIC, Clock, ClockType

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from studio.bags.recording import Recording, Split
    from studio.nodes.bag_player.offers import Offer
    from studio.nodes.bag_player.options import PlayOptions
    from studio.ros.client import Node

ROUND_S: Final = 0.1
"""A round takes at least so long: a bag of one moment would be played without a pause."""
_NEVER_NS: Final = 2**63 - 2
_WAIT_MAX_S: Final = 3_600.0


class BagPlayer:
    """Plays the topics of a recording by a node, in a thread of its own; thread-safe.

    Messages go out at the distances in which they were recorded, those that are due together at
    once. Latched messages from before the place at which playing begins, or goes on after a seek,
    come first. Publishers are there from the beginning on.

    Args:
        node: It speaks in the name of the player: publishes, tells `/clock`, and logs.
        recording: Read from a thread of the player's; close it after `stop`.
        options: See there.
        ended: Called in the player's thread when it has ended.
        splits: Where the files of the recording change, for those who follow that.
    """

    def __init__(
        self,
        node: Node,
        recording: Recording,
        options: PlayOptions,
        ended: Callable[[], object] = lambda: None,
        splits: Sequence[Split] = (),
    ) -> None:
        self._node, self._log = node, node.get_logger()
        self._recording, self._options, self._ended = recording, options, ended
        self._lock = threading.Lock()
        self._changed = Condition(self._lock)
        self._pace = Pace(self._begin_ns(), is_paused=options.starts_paused)
        self._reading: ReadAhead | None = None
        self._closed: list[ReadAhead] = []
        self._thread: threading.Thread | None = None
        self._is_playing = self._is_stopping = False
        self._sent = self._gone_to_ns = 0
        self._latched_ns: dict[str, int] = {}
        self.failure: BagError | None = None
        """Why the recording could not be played to its end; None: nothing was wrong."""
        self.set_rate(options.rate)
        self._offers = self._opened_offers()
        self._splits = SplitEvents(node, splits)
        self._clock_topics = options.clock_topics and full_names(options.clock_topics)
        self._clock_kind = node.wire.types.message("rosgraph_msgs/msg/Clock")
        self._clock_out, self._clock_timer = None, None
        if options.publishes_clock:
            self._clock_out = node.create_publisher(self._clock_kind, CLOCK_TOPIC, CLOCK_QOS)
        if options.clock_hz > 0:
            steady = Clock(clock_type=ClockType.STEADY_TIME)
            self._clock_timer = node.create_timer(
                1 / options.clock_hz, self._tell_time, clock=steady
            )
        node.on_destroy(self.stop)

    @property
    def is_playing(self) -> bool:
        """Whether it was begun, and has neither ended nor been stopped; a paused one is playing."""
        return self._is_playing

    @property
    def is_paused(self) -> bool:
        """Whether its time stands still."""
        return self._pace.is_paused

    @property
    def rate(self) -> float:
        """Seconds of the recording in a second."""
        return self._pace.rate

    @property
    def sent(self) -> int:
        """Messages that were published, without `/clock`."""
        return self._sent

    @property
    def topics(self) -> list[str]:
        """The topics that are played, as they were recorded."""
        return list(self._offers)

    def now_ns(self) -> int:
        """Return its time, since the Unix epoch; it does not pass the end."""
        with self._lock:
            return min(self._pace.now_ns(), self.span_ns()[1])

    def span_ns(self) -> tuple[int, int]:
        """Return where it begins and ends, since the Unix epoch."""
        begin_ns = self._begin_ns()
        return begin_ns, max(begin_ns, self._end_ns())

    def play(
        self,
        start_offset_ns: int | None = None,
        duration_ns: int | None = None,
        until_ns: int | None = None,
    ) -> bool:
        """Begin, at other times than the options say where they are given.

        Returns:
            False: it plays already.
        """
        with self._lock:
            if self._is_playing:
                self._log.warning("Trying to play() while in playback, dismissing request.")
                return False
            self._is_playing, self._is_stopping, self.failure = True, False, None
            if start_offset_ns is not None:
                self._options = replace(
                    self._options,
                    start_offset_ns=start_offset_ns,
                    duration_ns=duration_ns,
                    until_ns=until_ns,
                )
        last_ns = self._options.end_ns(self._begin_ns())
        self._log.info(f"Playback until timestamp: {-1 if last_ns is None else last_ns}")
        self._thread = threading.Thread(target=self._run, name="bag-player", daemon=True)
        self._thread.start()
        return True

    def stop(self) -> None:
        """End playing, and wait until it has ended; again is harmless."""
        with self._lock:
            if self._is_playing and not self._is_stopping:
                self._log.info("Stopping playback.")
            self._is_stopping = True
            self._changed.notify_all()
        thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join()

    def close(self) -> None:
        """Stop, and publish no more: the node stays; again is harmless."""
        self.stop()
        self._node.forget_destroy(self.stop)
        self._splits.close()
        for offer in self._offers.values():
            offer.publisher.destroy()
        if self._clock_timer is not None:
            self._node.destroy_timer(self._clock_timer)
        if self._clock_out is not None:
            self._node.destroy_publisher(self._clock_out)

    def wait(self, timeout_s: float | None = None) -> bool:
        """Wait until playing has ended; False when the time is over first."""
        with self._lock:
            return self._changed.wait_for(lambda: not self._is_playing, timeout_s)

    def pause(self) -> None:
        """Let its time stand still."""
        with self._lock:
            self._pace.pause()
            self._changed.notify_all()
        self._log.info("Pausing play.")

    def resume(self) -> None:
        """Let its time go on."""
        with self._lock:
            self._pace.resume()
            self._changed.notify_all()
        self._log.info("Resuming play.")

    def toggle_paused(self) -> None:
        """Pause, or go on."""
        if self.is_paused:
            self.resume()
        else:
            self.pause()

    def set_rate(self, rate: float) -> bool:
        """Play faster or slower; whether it is a rate: finite and above 0."""
        with self._lock:
            is_set = self._pace.set_rate(rate)
            self._changed.notify_all()
        if is_set:
            self._log.info(f"Set rate to {rate:g}")
        else:
            self._log.warning(f"Failed to set rate to invalid value {rate:g}")
        return is_set

    def play_next(self) -> bool:
        """Publish the next message of a paused player; False: it is not paused, or at its end."""
        with self._lock:
            if not self._pace.is_paused:
                self._log.warning("Called play next, but not in paused state.")
                return False
            return self._publish_next()

    def burst(self, count: int = 0) -> int:
        """Publish so many messages of a paused player at once, 0 for all; return how many."""
        if not self.is_paused:
            self._log.warning("Burst can only be used when in the paused state.")
            return 0
        played = 0
        while not count or played < count:
            with self._lock:  # anew for each: others may stop it, or let it go on
                if not self._pace.is_paused or not self._publish_next():
                    break
            played += 1
        self._log.info(f"Burst {played} messages.")
        return played

    def seek(self, at_ns: int) -> bool:
        """Go on at a time, not before the beginning; False: it does not play, or cannot be read."""
        with self._lock:
            if not self._is_playing or self._reading is None or self._is_stopping:
                return False
            try:
                self._go_to(max(at_ns, self._begin_ns()))
            except BagError as error:
                self._log.error(f"Failed to seek: {error}")
                return False
            self._changed.notify_all()
        return True

    def _begin_ns(self) -> int:
        return self._recording.begin_ns + self._options.start_offset_ns

    def _end_ns(self) -> int:
        """Return the last time that is played."""
        last_ns = self._options.end_ns(self._begin_ns())
        return min(self._recording.end_ns, _NEVER_NS if last_ns is None else last_ns)

    def _opened_offers(self) -> dict[str, Offer]:
        learn_types(self._node.wire.types, self._recording)
        choice = self._options.choice
        wanted = [one for one in self._recording.topics if choice.takes(one.name)]
        if self._options.publishes_clock:
            wanted = [one for one in wanted if one.name != CLOCK_TOPIC]
        overrides = self._options.overrides
        return open_offers(self._node, self._recording, wanted, overrides)

    def _run(self) -> None:
        try:
            while self._play_round() and self._options.is_looping:
                pass
        except BagError as error:
            self.failure = error
            self._log.error(f"Failed to play: {error}")
        except DestroyedError:  # the node ends, and its publishers have ended
            pass
        finally:
            self._close_reading()
            with self._lock:
                self._is_playing = False
                self._changed.notify_all()
            self._ended()

    def _close_reading(self) -> None:
        """Read no more, and wait until nothing is read."""
        with self._lock:
            if self._reading is not None:
                self._reading.close()
                self._closed.append(self._reading)
            closed, self._closed, self._reading = self._closed, [], None
        for one in closed:
            one.join()

    def _play_round(self) -> bool:
        """Play once from the beginning; False: it was stopped, or there was nothing to play."""
        if self._options.delay_ns:
            self._log.info(f"Sleep {self._options.delay_ns} ns")
        if not self._rest(self._options.delay_ns / NANOSECONDS):
            return False
        begun_s = time.monotonic()
        with self._lock:
            self._go_to(self._begin_ns())
            is_empty = self._wait_until_filled()
            self._pace.jump(self._gone_to_ns)  # what was read meanwhile took its time
        while self._publish_due():
            pass
        left_s = begun_s + ROUND_S - time.monotonic()
        return not is_empty and self._rest(left_s if self._options.is_looping else 0)

    def _rest(self, seconds: float) -> bool:
        """Do nothing for so long; False: it was stopped meanwhile."""
        with self._lock:
            self._changed.wait_for(lambda: self._is_stopping, max(0.0, seconds))
            return not self._is_stopping

    def _go_to(self, at_ns: int) -> None:
        """Play from a time on: first the time, then what is latched; the lock is held.

        Raises:
            BagError: The recording cannot be read.
        """
        latched = self._latched_before(at_ns)
        if self._reading is not None:
            self._reading.close()
            self._closed = [one for one in (*self._closed, self._reading) if one.is_alive]
        messages = self._recording.messages(self.topics, at_ns, self._end_ns() + 1)
        self._reading = ReadAhead(self._lock, self._changed, messages, self._options.read_ahead)
        self._gone_to_ns = at_ns
        self._pace.jump(at_ns)
        self._splits.restart()
        self._tell(at_ns)
        for one in latched:
            self._send(one)

    def _latched_before(self, at_ns: int) -> list[Recorded]:
        """Return what late subscribers of latched topics would get at a time, if it is another."""
        found: list[Recorded] = []
        for name, offer in self._offers.items():
            if not offer.is_latched:
                continue
            kept = self._recording.last(name, at_ns - 1, offer.kept)
            if kept and kept[-1].received_ns != self._latched_ns.get(name):
                found += [Recorded(name, one) for one in kept]
        return sorted(found, key=lambda one: one.sample.received_ns)

    def _wait_until_filled(self) -> bool:
        """Wait until enough was read to begin; whether there is nothing at all. The lock is held.

        Raises:
            BagError: The recording cannot be read.
        """
        while (reading := self._reading) is not None and not self._is_stopping:
            if reading.is_filled:
                return reading.head() is None
            self._changed.wait()
        return True

    def _publish_due(self) -> bool:
        """Wait until a message is due, and publish it; False: there is none any more.

        Raises:
            BagError: The recording cannot be read any further.
        """
        with self._lock:
            while (reading := self._reading) is not None and not self._is_stopping:
                head = reading.head()
                if head is None and reading.is_over and not self._pace.is_paused:
                    self._splits.tell_until(self._end_ns())  # files may have nothing to play
                    return False
                left_s = self._left_s(reading, head)
                if head is not None and left_s <= 0:
                    reading.pop()
                    self._publish(head)
                    return True
                self._changed.wait(min(left_s, _WAIT_MAX_S))
        return False

    def _left_s(self, reading: ReadAhead, head: Recorded | None) -> float:
        """Return how long to wait for what may change meanwhile."""
        if head is not None:
            return self._pace.left_s(head.sample.received_ns)
        if not reading.is_over:
            self._log.warning(
                "Message queue starved. Messages will be delayed. Consider increasing the "
                "--read-ahead-queue-size option.",
                throttle_duration_sec=1.0,
            )
        return _WAIT_MAX_S

    def _publish_next(self) -> bool:
        """Publish the next message now, while it is paused; the lock is held."""
        while (reading := self._reading) is not None and not self._is_stopping:
            try:
                head = reading.head()
            except BagError:  # it ends playing, which says so
                return False
            if head is not None:
                reading.pop()
                # Also where playing begins, if it is filled no sooner than now.
                self._gone_to_ns = head.sample.received_ns
                self._pace.jump(self._gone_to_ns)
                self._publish(head)
                return True
            if reading.is_over:
                return False
            self._changed.wait()
        return False

    def _publish(self, one: Recorded) -> None:
        self._splits.tell_until(one.sample.received_ns)
        triggers = self._clock_topics
        if triggers is not None and (not triggers or one.topic in triggers):
            self._tell(one.sample.received_ns)
        self._send(one)

    def _send(self, one: Recorded) -> None:
        offer = self._offers[one.topic]
        offer.publisher.send(one.sample.payload)
        self._sent += 1
        if offer.is_latched:
            self._latched_ns[one.topic] = one.sample.received_ns

    def _tell_time(self) -> None:
        with self._lock:
            self._tell(min(self._pace.now_ns(), self.span_ns()[1]))

    def _tell(self, at_ns: int) -> None:
        if self._clock_out is not None:
            clock = self._clock_kind()
            clock.clock.sec, clock.clock.nanosec = divmod(max(0, at_ns), NANOSECONDS)
            self._clock_out.publish(clock)
