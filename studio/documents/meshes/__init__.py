"""The meshes of a document: wanted, loaded beside, shown, and what lies hidden in them."""
