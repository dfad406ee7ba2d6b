"""Removal of broken contacts that have opened."""
from rockwear.engines.base import Engine


class Separation(Engine):
    """Erases broken bonds whose particles are apart, so that no later visit has to examine them."""

    name = "separation"

    def __init__(self, bonds, *, period=1):
        super().__init__(period=period)
        self.bonds = bonds

    def act(self):
        self.bonds.erase_separated()
