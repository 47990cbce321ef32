"""The time that a document shows: that of the live system, or a moment of a recording."""
