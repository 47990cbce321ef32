"""Files as they are written: elements, attributes and texts, each with its place in the bytes.

Nothing here knows what a text means to xacro.
"""
