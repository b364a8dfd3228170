"""The railpatch command: its group, what sub-commands share, tables on the terminal."""
