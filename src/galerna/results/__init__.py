"""What a simulation leaves behind: labelled arrays with units, on disk from the first record."""

from galerna.results.dataset import open_result
from galerna.results.export import to_csv, to_outb
from galerna.results.store import ResultFile

__all__ = ["ResultFile", "open_result", "to_csv", "to_outb"]
