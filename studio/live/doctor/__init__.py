"""The Doctor: why something does not work. Facts are gathered, and each subject concludes of them.

`watching.py` listens and asks, for as long as somebody wants to know; `seen.py` is what it found;
a file of `subjects/` for each subject makes findings of that, and is pure; `examination.py` puts
them together, and `report.py` writes them as one HTML file.
"""
