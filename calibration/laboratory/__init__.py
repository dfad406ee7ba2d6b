"""The virtual laboratory: tests of specimens."""
