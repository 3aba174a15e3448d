"""The steady power curve of a turbine, as a table and a picture."""

import numpy as np

import galerna
from galerna.report import power_curve_figure

turbine = galerna.load_turbine("nrel5mw")
curve = galerna.power_curve(turbine, np.arange(4.0, 26.0, 3.0))

print("wind speed [m/s]  power [MW]  thrust [kN]  pitch [deg]")
for wind in curve.wind_speed:
    here = curve.sel(wind_speed=wind)
    power, thrust = float(here.electrical_power) / 1e6, float(here.thrust) / 1e3
    print(
        f"{float(wind):16.1f}  {power:10.3f}  {thrust:11.1f}  {np.degrees(float(here.pitch)):11.2f}"
    )

power_curve_figure(curve, turbine.name).savefig("power_curve.png")
