"""Lessons of a class: their checks, looked at while somebody reads, and who has done which step."""
