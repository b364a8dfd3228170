"""Input files of the program CONTACT: read, as cases here, and results in its units and signs."""
