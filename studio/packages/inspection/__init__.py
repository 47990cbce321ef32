"""Folders of packages in, what they hold as frozen values out: nothing is built or run."""
