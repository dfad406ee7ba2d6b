"""What a page can show of a run, one subject a file. A view is a function run -> Section; None where the run lacks what
it shows."""
