from __future__ import annotations

from studio.ros.lifecycle.machine import ASKED, FOLLOWING, TRANSITIONS, StateId
from studio.ros.types.library import TypeLibrary

LIBRARY = TypeLibrary("jazzy")


def test_numbers_of_states_are_those_of_lifecycle_msgs():
    constants = LIBRARY.message("lifecycle_msgs/msg/State")
    for state in StateId:
        kind = "PRIMARY_STATE" if state < StateId.CONFIGURING else "TRANSITION_STATE"
        assert getattr(constants, f"{kind}_{state.name}") == state


def test_numbers_of_transitions_are_those_of_lifecycle_msgs():
    constants = LIBRARY.message("lifecycle_msgs/msg/Transition")
    names = {"CONFIGURE", "CLEANUP", "ACTIVATE", "DEACTIVATE"}
    asked = {one.label.upper(): one.id for one in ASKED if one.label != "shutdown"}
    assert asked == {name: getattr(constants, f"TRANSITION_{name}") for name in names}
    for one in ASKED:
        if one.label == "shutdown":
            name = f"TRANSITION_{one.start.name}_SHUTDOWN"
            assert getattr(constants, name) == one.id
    words = {
        "CONFIGURING": "CONFIGURE", "CLEANINGUP": "CLEANUP", "ACTIVATING": "ACTIVATE",
        "DEACTIVATING": "DEACTIVATE", "SHUTTINGDOWN": "SHUTDOWN", "ERRORPROCESSING": "ERROR",
    }  # fmt: skip
    for one in FOLLOWING:
        end = one.label.removeprefix("transition_").upper()
        assert getattr(constants, f"TRANSITION_ON_{words[one.start.name]}_{end}") == one.id


def test_there_are_25_transitions_each_with_a_number_of_its_own():
    assert len({one.id for one in TRANSITIONS}) == len(TRANSITIONS) == 25
