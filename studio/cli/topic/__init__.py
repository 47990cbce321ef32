"""`studio topic`: who publishes what, what is said, how often and how large; and to say it."""
