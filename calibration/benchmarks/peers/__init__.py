"""The same cut in other codes: specimen, bonds, tool and step are read out of YADE and written for the peer.

A peer is a module with NAME, PACKAGES of the package index, stretched(environment, model, folder, strain) and
cut(environment, model, folder, steps, sample).
"""
import numpy as np

STRAIN = np.array([[2e-5, 1e-5], [0.0, -1e-5]])
"""Displacement gradient of the static test."""
TIMED = 1000
"""Steps from the first on that are timed: later the codes have broken other bonds, and do other work."""


class PeerFailed(RuntimeError):
    """The peer cannot be installed, or does not run."""
