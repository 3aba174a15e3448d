"""What a person looks at: pictures of results, inflow and performance.

Every function returns a ``matplotlib.figure.Figure`` that no window owns.
"""

from galerna.report.curves import performance_surface_figure, power_curve_figure
from galerna.report.inflow import RotorCircle, inflow_figure
from galerna.report.pictures import plot_result
from galerna.report.rotor import floating_figure, machine_figure, rotor_figure
from galerna.report.spanwise import spanwise_figure
from galerna.report.spectra import spectra_figure

__all__ = [
    "RotorCircle",
    "floating_figure",
    "inflow_figure",
    "machine_figure",
    "performance_surface_figure",
    "plot_result",
    "power_curve_figure",
    "rotor_figure",
    "spanwise_figure",
    "spectra_figure",
]
