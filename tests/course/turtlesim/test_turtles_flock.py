from __future__ import annotations

from studio.course.turtlesim.turtles import TURTLES_MAX, Flock

BLUE = (69, 86, 255)


def test_turtles_without_a_name_are_counted():
    flock = Flock()
    names = [turtle.name for _ in range(3) if (turtle := flock.spawn(1.0, 1.0, 0.0))]
    assert names == ["turtle1", "turtle2", "turtle3"]


def test_a_name_is_given_once_and_counting_passes_over_it():
    flock = Flock()
    assert flock.spawn(1.0, 1.0, 0.0, "turtle1") is not None
    assert flock.spawn(2.0, 2.0, 0.0, "turtle1") is None
    counted = flock.spawn(2.0, 2.0, 0.0)
    assert counted is not None
    assert counted.name == "turtle2"


def test_the_ground_holds_so_many_and_no_more():
    flock = Flock()
    spawned = [flock.spawn(1.0, 1.0, 0.0) for _ in range(TURTLES_MAX + 1)]
    assert spawned[-1] is None
    assert None not in spawned[:-1]


def test_walking_draws_and_those_that_run_into_a_wall_are_named():
    flock = Flock()
    walker, runner = flock.spawn(5.0, 5.0, 0.0), flock.spawn(11.0, 5.0, 0.0)
    assert walker is not None
    assert runner is not None
    for turtle in (walker, runner):
        turtle.command(5.0, 0.0, 0.0)
    stopped = [flock.step() for _ in range(10)][-1]
    assert stopped == [runner]
    assert flock.color_below(walker, BLUE) == walker.pen.color
    flock.paper.clear()
    assert flock.color_below(walker, BLUE) == BLUE


def test_clearing_takes_all_away():
    flock = Flock()
    flock.spawn(1.0, 1.0, 0.0)
    flock.clear()
    assert flock.turtles == {}
    again = flock.spawn(1.0, 1.0, 0.0)
    assert again is not None
    assert again.name == "turtle1"
