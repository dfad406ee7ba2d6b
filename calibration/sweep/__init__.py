"""Sweeps: the rows of a yade-batch table, run here or on a cluster, resumed, and gathered on one page."""
