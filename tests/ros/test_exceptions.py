from __future__ import annotations

import pytest

from studio.ros.exceptions import ParameterException, ParameterNotDeclaredException
from studio.ros.parameters.store import ParameterStore


def test_errors_are_caught_by_the_names_of_rclpy():
    store = ParameterStore(lambda _: None)
    for kind in (ParameterNotDeclaredException, ParameterException):
        with pytest.raises(kind):
            store.get("nowhere")
