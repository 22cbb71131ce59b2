"""The figures of `hapticgiant haptify`."""

from . import free_space, responses, surfaces
from .measured import REAL_AND_SIMULATED, Measured


def figures(results):
    """The content of figures.json."""
    it = Measured(results["measurements"])
    for add in (free_space.add_workspace, free_space.add_free_space, surfaces.add_sliding,
                surfaces.add_stiffness, surfaces.add_peak, free_space.add_dynamics,
                responses.add_transparency, responses.add_force_response, responses.add_latency,
                surfaces.add_z_width, surfaces.add_impacts, responses.add_felt_mass,
                responses.add_rotation, responses.add_springs):
        add(it)
    return {**{key: value for key, value in results.items() if key != "measurements"},
            "real_and_simulated": REAL_AND_SIMULATED, "failures": it.failures, "impossible": it.impossible, "table": it.table,
            "beyond": it.beyond, "tables": it.tables, "curves": it.curves,
            "workspace": it.workspace}
