"""Interface texts in, types with hashes and classes of message values out."""
