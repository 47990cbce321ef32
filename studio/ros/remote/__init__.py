"""Other nodes: their parameters, states and types are asked for here, and answers come back."""

from studio.ros.remote.async_parameters import AsyncParameterClient
from studio.ros.remote.lifecycle import LifecycleClient
from studio.ros.remote.parameters import ParameterClient
from studio.ros.remote.type_asking import learn_from

__all__ = ["AsyncParameterClient", "LifecycleClient", "ParameterClient", "learn_from"]
