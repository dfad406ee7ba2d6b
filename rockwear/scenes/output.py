"""What the folder of a run shows of a scene."""
from abc import ABC, abstractmethod

from rockwear.engines.bond_log import Crack


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


def crack_table(cracks):
    """{file: (header, rows)} of broken bonds (engines.bonds.Crack), in order of time."""
    units = "s m m m - - - - J - -".split()
    return {"cracks.csv": ([f"{name} [{unit}]" for name, unit in zip(Crack._fields, units)], sorted(cracks))}
