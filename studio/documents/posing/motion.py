"""The moving of a document's joints: by hand, and in a swing through their limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.documents.posing.animation import Animation
from studio.documents.posing.glide import Glide
from studio.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.documents.board import Board
    from studio.documents.model import Model


class Motion:
    """Moves the joints of one model and tells the board where they stand."""

    def __init__(self, model: Model, board: Board) -> None:
        self._model, self._board = model, board
        self._animation = Animation(self._swing)
        self._glide = Glide(self._move)
        self._swing_start = model.joints.values
        self.leader = ""
        """What else moves the joints, in a word; while it does, nobody else may. Empty: nothing."""

    @property
    def swinging(self) -> bool:
        """Whether the joints swing now."""
        return self._animation.running

    def set(self, positions: Mapping[str, float]) -> None:
        """Move joints, rad or m by name; ends a swing.

        Raises:
            CommandError: Something else moves them; so for all that follow.
        """
        self._begin()
        self._move(positions)

    def glide(self, positions: Mapping[str, float], duration_s: float) -> None:
        """Move joints, rad or m by name, within a time; ends a swing."""
        self._begin()
        self._glide.start(self._model.joints.by_name(), positions, duration_s)

    def zero(self) -> None:
        """All joints to zero."""
        self._begin()
        self._model.joints.zero()
        self._show()

    def randomize(self) -> None:
        """All joints to random positions."""
        self._begin()
        self._model.joints.randomize()
        self._show()

    def animate(self, *, running: bool) -> None:
        """Swing the joints from where they are, or stop."""
        if running:
            self._demand_freedom()
        self._glide.stop()
        if running and not self.swinging:
            self._swing_start = self._model.joints.values
            self._animation.start()
        elif not running:
            self._animation.stop()
        self._board.joints()

    def lead(self, leader: str) -> None:
        """Let something else move the joints from now on, by `follow`; empty: nobody."""
        self._stop_swinging()
        self.leader = leader

    def follow(self, positions: Mapping[str, float]) -> None:
        """Move joints, rad or m by name, to where their leader says they are."""
        self._model.joints.follow(positions)
        self._show()

    def close(self) -> None:
        """End a swing without telling anybody."""
        self._glide.stop()
        self._animation.stop()

    def _swing(self, time_s: float) -> None:
        self._model.joints.swing(time_s, self._swing_start)
        self._show()

    def _move(self, positions: Mapping[str, float]) -> None:
        self._model.joints.set(positions)
        self._show()

    def _begin(self) -> None:
        self._demand_freedom()
        self._stop_swinging()

    def _demand_freedom(self) -> None:
        if self.leader:
            raise CommandError(
                f"The joints follow {self.leader}: choose the sliders as their source first."
            )

    def _stop_swinging(self) -> None:
        self._glide.stop()
        if self.swinging:
            self._animation.stop()
            self._board.joints()

    def _show(self) -> None:
        self._model.pose()
        self._board.joint_frame()
