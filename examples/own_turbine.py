"""Your own turbine: from a windIO file or an OpenFAST deck (.fst), changed, checked and run.

Usage: python own_turbine.py [my_turbine.yaml | my_turbine.fst]
"""

import sys
from dataclasses import replace
from pathlib import Path

import galerna
from galerna.turbine import windio

source = sys.argv[1] if len(sys.argv) > 1 else "nrel5mw"
turbine = galerna.load_turbine(source)

steeper = replace(turbine, nacelle=replace(turbine.nacelle, tilt=turbine.nacelle.tilt + 0.02))
windio.write(steeper, Path("steeper.yaml"))  # a valid windIO file, and a turbine for any case

result = galerna.run(
    {
        "galerna": 1,
        "turbine": "steeper.yaml",
        "duration_s": 10,
        "inflow": {"wind_speed_m_s": 9.0, "shear": {"kind": "power_law", "exponent": 0.14}},
        "operation": {"operating_point": "steady"},
    }
)
print(f"mean thrust {float(result.rotor_thrust.mean()) / 1e3:.1f} kN")
print(f"mean power {float(result.rotor_power.mean()) / 1e6:.3f} MW")
