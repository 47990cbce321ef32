"""What is drawn live in a document's 3D view: displays of topics, and frames from TF."""
