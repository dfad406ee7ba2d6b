"""The one page of all scenes: its views in order. Each says by itself whether a run has what it shows."""
from rockwear.report.views import (
    granular, heat_profiles, speeds, space, stress_strain, temperature, turns, wear_spheres)
from rockwear.report.views.balances import balances
from rockwear.report.views.cut import cut
from rockwear.report.views.density import density
from rockwear.report.views.forces import forces
from rockwear.report.views.history import history
from rockwear.report.views.key_results import key_results
from rockwear.report.views.load_displacement import load_displacement
from rockwear.report.views.outlines import outlines
from rockwear.report.views.record import how_it_was_run, results
from rockwear.report.views.set_up import set_up
from rockwear.report.views.sliding import worn_block
from rockwear.report.views.stages import stages
from rockwear.report.views.steady import steady_cut
from rockwear.report.views.trust import trust
from rockwear.report.views.two_disc import two_disc, two_disc_results
from rockwear.report.views.wear_particles import wear_particles
from rockwear.report.views.wear_segments import wear_segments
from rockwear.report.views.wear_triangles import wear_triangles

VIEWS = (
    key_results, steady_cut, stages, turns.turn_by_turn, two_disc_results, two_disc,
    granular.heap, granular.tube,
    heat_profiles.errors, heat_profiles.profiles, heat_profiles.convergence, heat_profiles.fields,
    stress_strain.stress_strain, load_displacement, stress_strain.failure, worn_block,
    speeds.speed_tables, speeds.tip_over_time, speeds.fields, speeds.near_the_tip,
    set_up, cut, space.perspective, space.side, density, forces, history,
    temperature.temperature, temperature.heating, temperature.cooling, turns.turns,
    wear_particles, wear_segments, wear_spheres.wear_spheres, wear_spheres.stages_of_wear, wear_triangles, outlines,
    turns.mass_loss, trust, balances, results, how_it_was_run)


def sections(run):
    """Sections of the page of a run, in order."""
    found = (view(run) for view in VIEWS)
    return [section for section in found if section]
