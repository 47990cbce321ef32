"""What an editor asks of a text: what a word means, where it is defined, how it goes on."""
