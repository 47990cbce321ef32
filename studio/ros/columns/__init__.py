"""Messages of many parts as columns: CDR to numpy arrays and back, with no object for each part."""

from __future__ import annotations
