"""Memory of the water: what waves that a platform made still do to it."""

from .convolution import Convolution, impulse_response
from .fit import fit_radiation, radiation_of
from .memory import Memory, NoMemory, StateSpaceMemory
from .state_space import RadiationStateSpace

__all__ = [
    "Convolution",
    "Memory",
    "NoMemory",
    "RadiationStateSpace",
    "StateSpaceMemory",
    "fit_radiation",
    "impulse_response",
    "radiation_of",
]
