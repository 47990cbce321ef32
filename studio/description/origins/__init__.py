"""Where each number of a part comes from, and what each text affects."""
