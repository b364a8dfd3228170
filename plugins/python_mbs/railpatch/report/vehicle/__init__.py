"""The report of a vehicle's run, from its log."""
