"""A run: parameters in, one folder out."""
