"""The virtual laboratory and the measurements behind defaults."""
