"""What one simulation is: a validated case, which a YAML file or a dictionary holds."""

from galerna.case.document import CaseError, Problem
from galerna.case.options import Block, Case, Operation, Outputs, Series
from galerna.case.reading import LoadedCase, load, parse

__all__ = [
    "Block",
    "Case",
    "CaseError",
    "LoadedCase",
    "Operation",
    "Outputs",
    "Problem",
    "Series",
    "load",
    "parse",
]
