"""The flexible double pendulum in SHARPy, run by SHARPy's own interpreter.

``python sharpy_pendulum.py FOLDER ELEMENTS STEPS DT`` prints the median CPU seconds of a
structural solution as the last word. Table 3.1's properties, three-node elements, Newmark.
"""

from __future__ import annotations

import statistics
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import sharpy.sharpy_main
import sharpy.utils.generate_cases as cases
from sharpy.solvers.nonlineardynamicmultibody import NonLinearDynamicMultibody

GRAVITY_AXIS_ANGLES = (np.pi / 2, 0.0)  # of the two links from the vertical


def link(nodes: int, angle: float, root: np.ndarray) -> tuple[Any, np.ndarray]:
    """A uniform beam of 1 m that hangs from ``root`` at an angle, and its nodes."""
    info = cases.AeroelasticInformation()
    span = np.linspace(0.0, 1.0, nodes)
    at = np.zeros((nodes, 3))
    at[:, 0] = root[0] + span * np.sin(angle)
    at[:, 2] = root[2] - span * np.cos(angle)
    structure = info.StructuralInformation
    structure.generate_uniform_sym_beam(
        at, 1.0, 1e-5, 1000.0, 1e5, 1e5, 1.0, num_node_elem=3, y_BFoR="y_AFoR", num_lumped_mass=1
    )
    structure.body_number = np.zeros(structure.num_elem, dtype=int)
    structure.boundary_conditions[0], structure.boundary_conditions[-1] = 1, -1
    structure.lumped_mass_nodes = np.array([nodes - 1])
    structure.lumped_mass = np.zeros(1)
    structure.lumped_mass_inertia = np.zeros((1, 3, 3))
    structure.lumped_mass_position = np.zeros((1, 3))
    flat = np.zeros((1, 20, 2))
    flat[:, :, 0] = np.linspace(0.0, 1.0, 20)
    info.AerodynamicInformation.create_one_uniform_aerodynamics(
        structure, chord=1.0, twist=0.0, sweep=0.0, num_chord_panels=4,
        m_distribution="uniform", elastic_axis=0.25, num_points_camber=20, airfoil=flat,
    )  # fmt: skip
    return info, at


def settings(simulation: Any, folder: str, name: str, dt: float, steps: int) -> None:
    """A structural run in time, without air."""
    solvers = simulation.solvers
    solvers["SHARPy"].update(
        flow=["BeamLoader", "AerogridLoader", "DynamicCoupled"], case=name, write_screen="off",
        route=folder, log_folder=folder + "output/",
    )  # fmt: skip
    simulation.set_variable_all_dicts("dt", dt)
    simulation.define_num_steps(steps)
    simulation.set_variable_all_dicts("rho", 0.0)
    simulation.set_variable_all_dicts("velocity_field_input", solvers["SteadyVelocityField"])
    solvers["BeamLoader"]["unsteady"] = "on"
    solvers["AerogridLoader"].update(
        unsteady="on", mstar=2, wake_shape_generator="StraightWake",
        wake_shape_generator_input={"u_inf": 1.0, "u_inf_direction": np.array([0.0, 1, 0]),
                                    "dt": dt},
    )  # fmt: skip
    multibody = solvers["NonLinearDynamicMultibody"]
    multibody.update(gravity_on=True, time_integrator="NewmarkBeta", write_lm=False)
    multibody["time_integrator_settings"] = {"newmark_damp": 0.01, "dt": dt}
    solvers["DynamicCoupled"].update(
        structural_solver="NonLinearDynamicMultibody", structural_solver_settings=multibody,
        aero_solver="NoAero", aero_solver_settings=solvers["NoAero"], postprocessors=[],
        postprocessors_settings={},
    )  # fmt: skip


def hinges(nodes: int) -> list[object]:
    """Both hinges about y."""
    top, middle = cases.LagrangeConstraint(), cases.LagrangeConstraint()
    top.behaviour, top.body_FoR = "hinge_FoR", 0
    top.rot_axis_AFoR = np.array([0.0, 1.0, 0.0])
    middle.behaviour = "hinge_node_FoR"
    middle.node_in_body, middle.body, middle.body_FoR = nodes - 1, 0, 1
    middle.rot_axisB = np.array([0.0, 1.0, 0.0])
    for hinge in (top, middle):
        hinge.scalingFactor, hinge.penaltyFactor = 1e6, 0.0
    return [top, middle]


def bodies(roots: list[np.ndarray]) -> list[object]:
    """One freely moving body per link."""
    out = []
    for number, root in enumerate(roots):
        body = cases.BodyInformation()
        body.body_number, body.FoR_movement = number, "free"
        body.FoR_position = np.concatenate((root, np.zeros(3)))
        body.FoR_velocity, body.FoR_acceleration = np.zeros(6), np.zeros(6)
        body.quat = np.array([1.0, 0.0, 0.0, 0.0])
        out.append(body)
    return out


def main(folder: str, elements: int, steps: int, dt: float) -> None:
    name, nodes = "pendulum", 2 * elements + 1
    route = str(Path(folder).resolve()) + "/"
    first, at = link(nodes, GRAVITY_AXIS_ANGLES[0], np.zeros(3))
    second, below = link(nodes, GRAVITY_AXIS_ANGLES[1], at[-1])
    first.assembly(second)
    simulation = cases.SimulationInformation()
    simulation.set_default_values()
    simulation.define_uinf(np.array([0.0, 1.0, 0.0]), 1.0)
    simulation.with_forced_vel = simulation.with_dynamic_forces = False
    settings(simulation, route, name, dt, steps)
    cases.clean_test_files(route, name)
    simulation.generate_solver_file()
    simulation.generate_dyn_file(steps)
    first.generate_h5_files(route, name)
    cases.generate_multibody_file(hinges(nodes), bodies([np.zeros(3), below[0]]), route, name)
    times: list[float] = []
    original = NonLinearDynamicMultibody.run

    def timed(self: object, **options: object) -> object:
        start = time.process_time()
        result = original(self, **options)
        times.append(time.process_time() - start)
        return result

    NonLinearDynamicMultibody.run = timed
    sharpy.sharpy_main.main(["", f"{route}{name}.sharpy"])
    print(statistics.median(times[1:]))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), float(sys.argv[4]))
