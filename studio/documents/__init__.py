"""Open descriptions: texts, runs, keeping, checks, variants, poses, their robot and their view."""
