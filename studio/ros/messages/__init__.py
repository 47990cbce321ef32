"""Messages by import: `from studio.ros.messages.std_msgs.msg import String`.

Modules below this one are made when they are asked for, of the types that are known; a hook
answers for names below this package and for no others.
"""

from studio.ros.messages.finder import install
from studio.ros.messages.shared import action, message, service, shared_types

__all__ = ["action", "message", "service", "shared_types"]

install(__name__)
