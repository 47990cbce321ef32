from __future__ import annotations

from studio.launch.plan import (
    Argument,
    Condition,
    Node,
    Parameter,
    Plan,
    Robot,
    Where,
    plan_from_json,
    plan_to_json,
)


def test_a_plan_survives_the_way_through_json():
    plan = Plan(
        "/ws/a.launch.py",
        arguments=(
            Argument("ur_type", choices=("ur5", "ur10"), where=Where("/ws/a.launch.py", 3)),
        ),
        nodes=(
            Node(
                1,
                "node",
                "demo",
                "talker",
                parameters=(
                    Parameter("rates", [1.0, 2.5]),
                    Parameter("robot_description", robot=0),
                ),
                condition=Condition("$(var gui)", None),
            ),
        ),
        robots=(Robot("/ws/a.xacro", "xacro", {"name": "ur"}, 1),),
    )
    assert plan_from_json(plan_to_json(plan)) == plan


def test_arguments_without_a_value_are_missing():
    plan = Plan("a", arguments=(Argument("one", value="1"), Argument("two")))
    assert [one.name for one in plan.missing] == ["two"]


def test_a_place_without_a_line_is_its_file():
    assert str(Where("a.launch.py", 4)) == "a.launch.py:4"
    assert str(Where("a.launch.py")) == "a.launch.py"
