"""Columns of markers in, a Drawing out: who is there, until when, and batches of what they show."""
