"""Error against run time: sets of problems, truth, measurements and the report."""
