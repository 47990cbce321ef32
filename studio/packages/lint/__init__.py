"""Packages in, what would fail when they are built or run out: a file for each subject."""
