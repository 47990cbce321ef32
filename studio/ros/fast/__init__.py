"""Transforms and markers as columns of numbers, read and written many times faster than objects."""
