"""Sources of the documentation; ``python -m docs.build`` makes what is generated."""
