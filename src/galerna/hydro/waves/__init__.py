"""Waves of the first order on water of constant depth, and the sea that they make."""

from galerna.hydro.waves.build import build_sea
from galerna.hydro.waves.current import Current
from galerna.hydro.waves.probe import WaveProbe
from galerna.hydro.waves.sea import Sea
from galerna.hydro.waves.series import Series

__all__ = ["Current", "Sea", "Series", "WaveProbe", "build_sea"]
