"""How continuous the forces of a wheel are in its position and velocity: ``railpatch continuity``."""
