"""The open documents: commands in, events out, undo, the tick."""
