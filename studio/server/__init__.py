"""The pages, lanes and access of the one port: the only room that imports fastapi and uvicorn."""
