"""One steady point of operation: thrust, power and the loads along the blade."""

import numpy as np

import galerna

turbine = galerna.load_turbine("nrel5mw")
rotor = galerna.steady_rotor(turbine, wind_speed=8.0, rotor_speed=9.16 * np.pi / 30, pitch=0.0)

power, thrust = float(rotor.power) / 1e6, float(rotor.thrust) / 1e3
print(f"{turbine.name}: power {power:.3f} MW, thrust {thrust:.0f} kN")
print(f"power coefficient {float(rotor.power_coefficient):.3f}")
print("radius [m]  angle of attack [deg]  axial induction")
for strip in rotor.radius:
    here = rotor.sel(radius=strip)
    angle = np.degrees(float(here.angle_of_attack))
    print(f"{float(strip):10.2f}  {angle:21.2f}  {float(here.axial_induction):15.3f}")
