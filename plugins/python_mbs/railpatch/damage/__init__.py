"""Wear and rolling contact fatigue from the tractions and slips of a contact."""
