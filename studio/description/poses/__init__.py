"""Named joint positions from the files around a robot: group states, initial, one's own."""
