"""Checks of a document: run when nobody edits, listed as problems, with their fixes."""
