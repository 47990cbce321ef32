"""What is wrong with a document: looked for when it is quiet, listed, and mended by a click."""
