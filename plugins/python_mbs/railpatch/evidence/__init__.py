"""What measures Railpatch itself: errors against run time, stability, continuity, its tables.

Nothing that solves a case imports from here.
"""
