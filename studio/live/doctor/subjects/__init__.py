"""What the Doctor looks at: a file per subject, found by its name, each pure.

`SUBJECT` names it, `findings(seen)` yields what is wrong, `looked_at(seen)` says what there was to
look at; None: nothing was.
"""
