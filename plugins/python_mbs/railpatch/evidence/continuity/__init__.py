"""How continuous a wheel's forces are in position and velocity: ``railpatch continuity``."""
