"""Checks of a finished run: texts that were probably not meant as written, and their fixes."""
