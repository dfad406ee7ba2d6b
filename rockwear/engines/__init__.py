"""Engines that run from YADE's loop by PyRunner; one a file."""
