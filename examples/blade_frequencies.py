"""Natural frequencies of a blade, standing and turning, from its section matrices.

Usage: python blade_frequencies.py [turbine | my_turbine.yaml | my_turbine.fst]
"""

import sys

import numpy as np

import galerna
from galerna.structure.assembly import GROUND, Structure
from galerna.structure.beam import discretise
from galerna.structure.modes import natural_modes
from galerna.structure.statics import static_equilibrium
from galerna.structure.turbine import axis_curve
from galerna.units import RPM

turbine = galerna.load_turbine(sys.argv[1] if len(sys.argv) > 1 else "nrel5mw")
blade, hub = turbine.blade, turbine.hub
if blade.structure is None:
    sys.exit(f"{turbine.name}: the file gives no section stiffness of the blade")

root = np.array([0.0, 0.0, hub.radius])  # the shaft is the x axis, the blade points up
curve = axis_curve(blade.axis_span, blade.axis, np.eye(3), root, blade.structure)
beam = discretise(curve, blade.length, blade.structure, span=np.linspace(0.0, 1.0, 21))

structure = Structure(gravity=(0.0, 0.0, 0.0))
structure.beam("blade", beam, root=GROUND)
system = structure.build()

print(f"{turbine.name}: blade of {blade.length:.1f} m, frequencies in the blade's own axes")
print("rotor speed [rpm]   first four modes [Hz]")
for speed_rpm in (0.0, 6.0, 12.0):
    shaft_speed = np.array([speed_rpm * RPM, 0.0, 0.0])
    state = static_equilibrium(system, spin=(np.zeros(3), shaft_speed))
    frequencies = natural_modes(system, state, 4).frequency
    print(f"{speed_rpm:17.1f}   " + "  ".join(f"{f:.3f}" for f in frequencies))
