"""Masters that couple the wheelset with its contact in an FMU, and how long their steps may be.

held: forces held over steps, from the process or an FMU. multibody: the wheelset without its
contact. instance, slave: the FMU through fmpy. masters: who exchanges what, when. linear: the same
as matrices. stability: the largest stable step of each by runs. energy: what the coupling makes or
loses. report: table and plot.
"""
