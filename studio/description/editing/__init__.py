"""The texts of an open document: edited, undone, merged with the disk and saved byte by byte."""
