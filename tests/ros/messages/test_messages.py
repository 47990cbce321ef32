from __future__ import annotations

import importlib
import sys

import pytest

from studio.ros.messages import MessageFinder, action, install, message, service, shared_types


def imported(name: str):
    return importlib.import_module(f"studio.ros.messages.{name}")


def test_a_message_is_imported_as_in_ros():
    strings = imported("std_msgs.msg")
    assert strings.String(data="hello").data == "hello"
    assert strings.String is message("std_msgs/msg/String")


def test_services_and_actions_have_their_parts():
    adds, fibonacci = imported("example_interfaces.srv"), imported("example_interfaces.action")
    assert adds.AddTwoInts.Request(a=1, b=2).b == 2
    assert fibonacci.Fibonacci.Goal(order=3).order == 3
    assert adds.AddTwoInts == service("example_interfaces/srv/AddTwoInts")
    assert fibonacci.Fibonacci == action("example_interfaces/action/Fibonacci")


def test_a_package_that_nobody_knows_is_no_module():
    with pytest.raises(ModuleNotFoundError):
        imported("no_such_msgs")


def test_a_kind_that_a_package_has_not_is_no_module():
    with pytest.raises(ModuleNotFoundError):
        imported("std_msgs.srv")


@pytest.mark.parametrize("name", ["Strings", "string", "__path", "_x"])
def test_a_type_that_a_package_has_not_is_no_attribute(name: str):
    assert not hasattr(imported("std_msgs.msg"), name)


def test_a_module_lists_its_types():
    assert {"String", "Bool", "Header"} <= set(dir(imported("std_msgs.msg")))


def test_a_type_given_later_is_imported_at_once(monkeypatch: pytest.MonkeyPatch):
    # A library of its own: other tests keep the classes that they have.
    monkeypatch.setenv("ROS_DISTRO", "kilted")
    shared_types().add_texts({"given_later_msgs/msg/Late": "int32 number"})
    assert imported("given_later_msgs.msg").Late(number=4).number == 4


def test_names_outside_of_the_package_are_left_to_others():
    finder = MessageFinder("studio.ros.messages")
    assert finder.find_spec("std_msgs") is None
    assert finder.find_spec("std_msgs.msg") is None
    assert finder.find_spec("studio.ros.messagesx.std_msgs") is None
    assert finder.find_spec("studio.ros.messages.std_msgs.msg.deep") is None


def test_the_hook_is_installed_once():
    install("studio.ros.messages")
    assert sum(isinstance(one, MessageFinder) for one in sys.meta_path) == 1
