from __future__ import annotations

from studio.launch.plan import (
    Plan,
    PlannedArgument,
    PlannedCondition,
    PlannedNode,
    PlannedParameter,
    PlannedRobot,
    Where,
    plan_from_json,
    plan_to_json,
)


def test_a_plan_survives_the_way_through_json():
    plan = Plan(
        "/ws/a.launch.py",
        arguments=(
            PlannedArgument("ur_type", choices=("ur5", "ur10"), where=Where("/ws/a.launch.py", 3)),
        ),
        nodes=(
            PlannedNode(
                1,
                "node",
                "demo",
                "talker",
                parameters=(
                    PlannedParameter("rates", [1.0, 2.5]),
                    PlannedParameter("robot_description", robot=0),
                ),
                condition=PlannedCondition("$(var gui)", None),
            ),
        ),
        robots=(PlannedRobot("/ws/a.xacro", "xacro", {"name": "ur"}, 1),),
    )
    assert plan_from_json(plan_to_json(plan)) == plan


def test_arguments_without_a_value_are_missing():
    plan = Plan("a", arguments=(PlannedArgument("one", value="1"), PlannedArgument("two")))
    assert [one.name for one in plan.missing] == ["two"]


def test_a_place_without_a_line_is_its_file():
    assert str(Where("a.launch.py", 4)) == "a.launch.py:4"
    assert str(Where("a.launch.py")) == "a.launch.py"
