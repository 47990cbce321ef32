"""A class: people join a shared studio, one of them has control, and each finds their place again.

What is kept of it is one file in the data folder, which `end_class` deletes.
"""
