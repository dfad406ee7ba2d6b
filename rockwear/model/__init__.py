"""What is simulated, without YADE: rock, tools, materials."""
