"""Power and thrust coefficients over pitch and tip-speed ratio, 100 by 100, with a picture."""

import numpy as np

import galerna
from galerna.report import performance_surface_figure

turbine = galerna.load_turbine("nrel5mw")
surface = galerna.performance_surface(
    turbine, tip_speed_ratios=np.linspace(2, 14, 100), pitches=np.radians(np.linspace(-5, 25, 100))
)

best = surface.power_coefficient.isel(surface.power_coefficient.argmax(...))
ratio, pitch = float(best.tip_speed_ratio), np.degrees(float(best.pitch))
print(
    f"largest power coefficient {float(best):.3f} at tip-speed ratio {ratio:.2f}, {pitch:.1f} deg"
)

performance_surface_figure(surface, turbine.name).savefig("performance_surface.png")
