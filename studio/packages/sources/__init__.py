"""The files of a package's source in, what each says and where in its bytes out: nothing is run."""
