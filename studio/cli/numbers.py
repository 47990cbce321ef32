"""Whole numbers on the command line, each with its least value."""

from __future__ import annotations

import argparse


def count(text: str) -> int:
    """Read a number from 1 on; a mistake is an argparse error that says so."""
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{number} is too few: give 1 or more")
    return number


def whole(text: str) -> int:
    """Read a number from 0 on; a mistake is an argparse error that says so."""
    number = int(text)
    if number < 0:
        raise argparse.ArgumentTypeError(f"{number} is less than 0")
    return number
