"""The time that a document shows: now, the last minutes, or a moment of a bag."""
