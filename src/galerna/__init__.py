"""galerna: floating wind turbines simulated as one machine."""

__version__ = "0.1.0"
