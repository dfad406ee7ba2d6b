"""Physics without YADE: pure functions and small classes over arrays."""
