"""Engines that are visited within the steps of YADE's loop, by PyRunner, or between them; one a file."""
