"""A lubricated ball on a plane with slippy 0.5.2 (MIT), in an environment of its own.

slippy is no dependency of the package, and nothing of it is imported there. It needs older versions of
others. Any folder outside the repository will do:

    python3 -m venv <folder>
    <folder>/bin/pip install 'numpy<2' scipy==1.10.1 scikit-image numba sympy pyfftw tinydb matplotlib
    <folder>/bin/pip install --no-deps --ignore-requires-python slippy==0.5.2

The contact is the example that its class `IterSemiSystem` comes with: a ball of 19.05 mm under 800 N at
4 m/s, oil of Roelands and of Dowson and Higginson, twice the radius of the contact on all sides. Only the
number of nodes and the factor of relaxation are free.

Its last line is JSON: processor seconds of the solve, and the film in the middle [m].
"""

import argparse
import json
import time
import warnings

import slippy

slippy.CUDA = False

import slippy.contact as c  # noqa: E402
import slippy.surface as s  # noqa: E402

RADIUS, LOAD, SPEED, MODULUS, POISSON = 0.01905, 800.0, 4.0, 200e9, 0.3
VISCOSITY, ROELANDS_PRESSURE, ROELANDS_Z = 0.096, 1.0 / 5.1e-9, 0.68


def model(nodes: int, relaxation: float) -> c.ContactModel:
    """The contact on a square grid."""
    flat, both = [float("inf")] * 2, [MODULUS] * 2
    hertz = c.hertz_full([RADIUS] * 2, flat, both, [POISSON] * 2, LOAD)
    largest, half_width = hertz["max_pressure"], hertz["contact_radii"][0]
    ball = s.RoundSurface(
        (RADIUS,) * 3, shape=(nodes, nodes), extent=(4.0 * half_width,) * 2, generate=True
    )
    plane = s.FlatSurface()
    ball.material = plane.material = c.Elastic("steel", {"E": MODULUS, "v": POISSON})
    oil = c.Lubricant("oil")
    laws = c.lubricant_models
    viscosity = laws.nd_roelands(VISCOSITY, ROELANDS_PRESSURE, largest, ROELANDS_Z)
    oil.add_sub_model("nd_viscosity", viscosity)
    oil.add_sub_model("nd_density", laws.nd_dowson_higginson(largest))
    found = c.ContactModel("ball", ball, plane, oil)
    reynolds = c.UnifiedReynoldsSolver(
        time_step=0,
        grid_spacing=ball.grid_spacing,
        hertzian_pressure=largest,
        radius_in_rolling_direction=RADIUS,
        hertzian_half_width=half_width,
        dimentional_viscosity=VISCOSITY,
        dimentional_density=872,
    )
    corners = zip(ball.get_points_from_extent(), ball._total_shift, strict=True)
    places = (at + shift for at, shift in corners)
    begin = [hertz["total_deflection"], hertz["pressure_f"](*places)]
    found.add_step(
        c.IterSemiSystem(
            "main",
            reynolds,
            SPEED,
            1,
            no_time=True,
            normal_load=LOAD,
            initial_guess=begin,
            relaxation_factor=relaxation,
            max_it_interference=3000,
        )
    )
    return found


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--nodes", type=int, default=65)
    parser.add_argument("--relaxation", type=float, default=0.05)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    one, middle = model(given.nodes, given.relaxation), given.nodes // 2
    begin = time.process_time()
    state = one.solve()
    seconds = time.process_time() - begin
    print(json.dumps({"seconds": seconds, "film": float(state["gap"][middle, middle])}))


if __name__ == "__main__":
    main()
