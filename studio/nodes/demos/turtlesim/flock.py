"""Flock: the turtles by name, on the paper they draw on."""

from __future__ import annotations

from studio.nodes.demos.turtlesim.paper import Paper
from studio.nodes.demos.turtlesim.turtle import STEP_S, Turtle

TURTLES_MAX = 100


class Flock:
    """All turtles of one ground."""

    def __init__(self) -> None:
        self.paper = Paper()
        self.turtles: dict[str, Turtle] = {}
        self._count = 0

    def spawn(self, x: float, y: float, theta: float, name: str = "") -> Turtle | None:
        """Put one more turtle on the ground; None where its name is taken or the ground is full."""
        if not name:
            name = self._next_name()
        if name in self.turtles or len(self.turtles) >= TURTLES_MAX:
            return None
        turtle = self.turtles[name] = Turtle(name)
        turtle.teleport(x, y, theta)
        return turtle

    def step(self, step_s: float = STEP_S) -> list[Turtle]:
        """Let all walk one step, drawing; gives those that ran into a wall."""
        stopped: list[Turtle] = []
        for turtle in self.turtles.values():
            start = (turtle.x, turtle.y)
            if not turtle.step(step_s):
                stopped.append(turtle)
            if start != (turtle.x, turtle.y):
                self.paper.draw(start, (turtle.x, turtle.y), turtle.pen)
        return stopped

    def color_below(self, turtle: Turtle, background: tuple[int, int, int]) -> tuple[int, int, int]:
        """Give the colour of the ground where a turtle is."""
        return self.paper.color_at(turtle.x, turtle.y) or background

    def clear(self) -> None:
        """Take all turtles away and wipe the paper; counting begins anew."""
        self.turtles.clear()
        self.paper.clear()
        self._count = 0

    def _next_name(self) -> str:
        self._count += 1
        while f"turtle{self._count}" in self.turtles:
            self._count += 1
        return f"turtle{self._count}"
