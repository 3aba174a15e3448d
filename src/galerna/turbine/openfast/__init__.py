"""OpenFAST decks in: an .fst file and what it names become a Turbine."""

from galerna.turbine.openfast.reader import read

__all__ = ["read"]
