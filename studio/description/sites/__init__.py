"""The texts of a description that can be edited: found, measured, and given a widget."""
