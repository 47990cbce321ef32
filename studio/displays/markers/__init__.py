"""Columns of markers in, a Drawing out: which markers exist, until when, drawn in batches."""
