"""Other states of the same files: variants kept, applied, and compared with the present one."""
