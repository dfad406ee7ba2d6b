"""From laboratory tests to parameters."""
