"""windIO v2, the wind energy community's own turbine format, in and out."""

from galerna.turbine.windio.reader import read
from galerna.turbine.windio.writer import write

__all__ = ["read", "write"]
