"""A controller of your own, step by step: what the sensors show in, pitch and torque out."""

import numpy as np

import galerna

CASE = {
    "galerna": 1,
    "turbine": "nrel5mw",
    "duration_s": 30.0,
    "time_step_s": 0.05,
    "inflow": {"wind_speed_m_s": 15.0},
    "structure": {"blades": "rigid", "tower": "rigid"},
    "control": {"model": "external", "pitch_actuator": {"frequency_hz": 1.0}},
}
RATED_SPEED, RATED_TORQUE = 122.9, 43093.55  # rad/s and N m, of the generator


def pitch_for(measured, before):
    """A bare integral controller with the measured acceleration as its damping."""
    error = measured.generator_speed - RATED_SPEED
    acceleration = measured.generator_speed - before.generator_speed
    return measured.pitch.mean() + 1e-4 * error + 0.02 * acceleration


with galerna.start(CASE) as sim:
    before = now = sim.measure()
    calm = sim.state()  # all that the next step depends on, as arrays
    while sim.time < 10.0:
        before, now = now, sim.step(pitch=pitch_for(now, before), torque=RATED_TORQUE)
    print(f"{sim.time:.1f} s: {now.rotor_speed:.4f} rad/s, {now.electrical_power / 1e6:.3f} MW")

    sim.restore(calm)  # the same start again, and now the grid is lost
    while sim.time < 5.0:
        now = sim.step(torque=0.0, pitch=np.pi / 2)  # as fast as the actuators can
    print(f"{sim.time:.1f} s without the grid: {now.rotor_speed:.4f} rad/s")
    print(f"aerodynamic thrust then: {sim.record()['rotor_thrust'] / 1e3:.1f} kN")
