"""Watches the nodes of a program from a thread of its own, and says hints about them."""

from __future__ import annotations

import sys
import threading
import time
import weakref
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from studio.importable.hints.said import ROOM, Said, are_wanted, is_users, place
from studio.ros.node.base import NodeBase, node_listeners, was_spun
from studio.ros.node.service import Service
from studio.ros.node.subscription import Subscription
from studio.ros.node.timer import Timer

if TYPE_CHECKING:
    from types import FrameType

    from studio.importable.hints.ends import Ends

_EVERY_S: Final = 0.5
UNSPUN_S: Final = 5.0
"""So long after it was made a node of a program that goes on should be spun."""
_GRAPH_FROM_LOOK: Final = 3
"""The graph is looked at once a node has begun: most programs that end at once need it never."""
_OWN_TOPICS: Final = frozenset({"/clock", "/parameter_events"})
_OWN_SERVICES: Final = frozenset(
    {
        *("describe_parameters", "get_parameters", "get_parameter_types", "list_parameters"),
        *("set_parameters", "set_parameters_atomically", "get_type_description"),
        *("get_logger_levels", "set_logger_levels"),
    }
)


@dataclass
class _Made:
    """A node of the program, and where it was made."""

    node: weakref.ref[NodeBase]
    name: str
    kind: str
    at: str
    since_s: float
    was_spun: bool = False
    waiting: str = ""
    """What would be called if it were spun."""


class Watch:
    """Hints about one program; begins with its first node, and costs nothing before."""

    def __init__(self) -> None:
        self._said = Said()
        self._ends: Ends | None = None
        self._made: list[_Made] = []
        self._files: set[str] = set()
        self._over = threading.Event()
        self._thread: threading.Thread | None = None

    def begin(self) -> None:
        """Watch the nodes that are made from now on."""
        node_listeners.append(self._node_made)

    def end(self, error: BaseException | None = None, file: str | None = None) -> None:
        """Say what is seen only at the end.

        Args:
            error: What ended the program; None: it ended as it was meant to.
            file: The program, where it is a file that was run as such.
        """
        self._over.set()
        if self._node_made in node_listeners:
            node_listeners.remove(self._node_made)
        if isinstance(error, ImportError | SyntaxError | TypeError):
            self._say_ending(error)
        if error is None or (isinstance(error, SystemExit) and not error.code):
            for made in self._made:
                self._note(made)
                self._say_unspun(made)
        if error is None and file is not None and not self._made:
            self._say_uncalled(file)

    def _node_made(self, node: NodeBase) -> None:
        frame = _outer(sys._getframe(1))  # pyright: ignore[reportPrivateUsage]
        at = place(frame) if frame is not None else ""
        if frame is not None:
            self._files.add(frame.f_code.co_filename)
        name = node.get_fully_qualified_name()
        self._made.append(_Made(weakref.ref(node), name, type(node).__name__, at, time.monotonic()))
        node.context.on_close(self._look_at_nodes)
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="hints", daemon=True)
            self._thread.start()

    def _look_at_nodes(self) -> None:
        """Note how the nodes stand, before the context destroys them."""
        for made in self._made:
            self._note(made)

    def _note(self, made: _Made) -> None:
        node = made.node()
        if node is None:
            return
        made.was_spun = made.was_spun or was_spun(node)
        made.waiting = _waiting(node) or made.waiting

    def _say_ending(self, error: BaseException) -> None:
        from studio.importable.hints.endings import ending_hint  # noqa: PLC0415 - seldom needed

        if sentence := ending_hint(error):
            self._said.say("ending", sentence)

    def _say_uncalled(self, file: str) -> None:
        from studio.importable.hints.endings import uncalled_hint  # noqa: PLC0415 - seldom needed

        if sentence := uncalled_hint(file):
            self._said.say("ending", sentence)

    def _run(self) -> None:
        """Look again and again; what is needed is imported once the program has begun."""
        if self._over.wait(_EVERY_S):
            return
        from studio.importable.hints.stacks import Stacks  # noqa: PLC0415

        stacks = Stacks(self._said)
        looks = 0
        while not self._over.wait(_EVERY_S):
            looks += 1
            try:
                stacks.look()
                if looks >= _GRAPH_FROM_LOOK:
                    self._look_at_graph()
                self._look_at_nodes()
                self._look_at_unspun()
            except Exception:  # noqa: BLE001 - of a context that is closed: hints harm nobody
                continue

    def _look_at_graph(self) -> None:
        for made in self._made:
            node = made.node()
            if node is not None and node.context.ok():
                if self._ends is None:
                    from studio.importable.hints.ends import Ends  # noqa: PLC0415

                    self._ends = Ends(self._said, node.context.wire.zid, node.context.graph)
                self._ends.look(frozenset(self._files))
                return

    def _look_at_unspun(self) -> None:
        """Say which nodes nothing spins, though the program goes on."""
        now_s = time.monotonic()
        late = [one for one in self._made if now_s - one.since_s >= UNSPUN_S]
        late = [one for one in late if one.waiting and not one.was_spun]
        if not late or _is_in_the_studio(threading.main_thread().ident):
            return
        for one in late:
            node = one.node()
            if node is not None and node.context.ok():
                at = f", made at {one.at}," if one.at else ""
                self._said.say(
                    f"unspun {one.name}",
                    f"The node {one.name}{at} is there for {UNSPUN_S:.0f} s and was not spun: "
                    f"{one.waiting} is not called before; write rclpy.spin(node) in place of a "
                    "loop of your own, or rclpy.spin_once(node) in it.",
                )

    def _say_unspun(self, made: _Made) -> None:
        if made.was_spun or not made.waiting:
            return
        at = f", made at {made.at}," if made.at else ""
        self._said.say(
            f"unspun {made.name}",
            f"The program ended, and its node {made.name}{at} was never spun: {made.waiting} was "
            "never called; write rclpy.spin(node) behind it.",
        )


def _is_in_the_studio(thread: int | None) -> bool:
    """Whether a thread waits in a function of ours, or makes a node: other hints tell of these."""
    frame = sys._current_frames().get(thread or 0)  # pyright: ignore[reportPrivateUsage]
    while frame is not None and not is_users(frame):
        if frame.f_code.co_filename.startswith(ROOM):
            return True
        frame = frame.f_back
    while frame is not None:
        is_constructor = frame.f_code.co_name == "__init__"
        if is_constructor and isinstance(frame.f_locals.get("self"), NodeBase):
            return True
        frame = frame.f_back
    return False


def _outer(frame: FrameType | None) -> FrameType | None:
    """Return the user's frame that made a node, outside of the constructors of its class."""
    found = None
    while frame is not None:
        if is_users(frame):
            found = frame
            if frame.f_code.co_name != "__init__":
                return frame
        frame = frame.f_back
    return found


def _waiting(node: NodeBase) -> str:
    """Return what of a node is only called while it is spun; empty: nothing."""
    for work in node.all_work:
        if isinstance(work, Timer):
            return "its timer's callback"
        if isinstance(work, Subscription) and work.topic_name not in _OWN_TOPICS:
            return f"its callback for {work.topic_name}"
        if isinstance(work, Service):
            name = work.endpoint.token.name
            if name.rpartition("/")[2] not in _OWN_SERVICES:
                return f"its callback for {name}"
    return ""


def begin() -> Watch | None:
    """Begin to watch this process; None: hints are not wanted."""
    if not are_wanted():
        return None
    watch = Watch()
    watch.begin()
    return watch
