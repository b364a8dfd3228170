"""Creep forces of elliptic contacts, tabulated by the full theory: `railpatch table`.

core/fast/creep_table.hpp tells what the table holds and how it is interpolated.
"""
