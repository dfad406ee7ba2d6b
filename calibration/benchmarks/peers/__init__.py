"""The same cut in other codes: specimen, bonds, tool and step are read out of YADE and written for the peer."""
