"""What PACKAGE EXECUTABLE starts: found, checked and said in one place; nothing is run here."""
