"""What the folder of a run shows of a scene."""
from abc import ABC, abstractmethod

import numpy as np

from rockwear.engines.bond_log import Crack
from rockwear.kernels.density import control_volume_density
from rockwear.kernels.packing import volumes


class Output(ABC):
    """Arrays, results and balances of a scene, for its snapshots, summary and tables."""

    def __init__(self, scene):
        self.scene = scene

    @abstractmethod
    def model(self):
        """{name: array} that stays the same all through a run."""

    @abstractmethod
    def snapshot(self):
        """{name: array} of the scene now."""

    @abstractmethod
    def results(self):
        """{name: (value, unit)} of the run."""

    @abstractmethod
    def balances(self):
        """{name: (balance, unit)}, a balance {entry: value}."""

    @abstractmethod
    def write_vtk(self, folder, number):
        """Write the scene now for ParaView."""

    @abstractmethod
    def progress(self):
        """A few words on how the run stands."""

    def warnings(self):
        """Lines on what in this run's results is not to be relied on."""
        return []

    def write_shape(self, folder):
        """Write the tool's shape into the folder where it may have changed and another run can take it."""

    def tables(self):
        """{file: (header, rows)} of further tables."""
        return {}

    def growing_tables(self):
        """Those of `tables` that are written at every checkpoint too: all, unless some are costly to evaluate."""
        return self.tables()


def crack_table(cracks):
    """{file: (header, rows)} of broken bonds (engines.bonds.Crack), in order of time."""
    units = "s m m m - - - - J - -".split()
    return {"cracks.csv": ([f"{name} [{unit}]" for name, unit in zip(Crack._fields, units)], sorted(cracks))}


def density_map(rock, places, control_radius):
    """{"density": (n,) kg/m3} of rock around each of its particles [Rojek 2003, eq. 7.9], nothing for a control_radius
    of 0; places: (n, d) m, nan for particles that are not there. Only rock counts, not the tool in it."""
    if not control_radius:
        return {}
    there = np.isfinite(places).all(axis=1)
    density = np.full(rock.count, np.nan)
    density[there] = control_volume_density(
        positions=places[there], radii=rock.radii[there], ratio=control_radius,
        densities=rock.masses[there] / volumes(rock.radii[there], rock.dimensions))
    return {"density": density}
