"""The time loop in your own hands: step, look, save the state, go back, go on."""

import galerna
from galerna.simulation import Callback

case = galerna.load_case("yawed")
simulation = galerna.build_machine(case).simulation

for _ in range(100):
    simulation.advance()
print(f"thrust at {simulation.time:.2f} s: {simulation.record()['rotor_thrust'] / 1e3:.3f} kN")

saved = simulation.state()  # all that the next step depends on, as arrays
simulation.run(5.0)
first = simulation.record()["rotor_thrust"]

simulation.restore(saved)
simulation.run(5.0)
print(f"the same again after going back: {simulation.record()['rotor_thrust'] == first}")


class StopAtHighThrust(Callback):
    """What happens beside a simulation is a callback: it sees every accepted step."""

    def accepted(self, simulation):
        if simulation.record()["rotor_thrust"] > 300e3:
            simulation.stop("the thrust is above 300 kN")


simulation.run(60.0, [StopAtHighThrust()])
print(f"ended at {simulation.time:.2f} s: {simulation.stopped or 'complete'}")
