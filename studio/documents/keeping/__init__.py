"""What becomes of edits: saved, exported, shared, kept; and the files beside a robot."""
