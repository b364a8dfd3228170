"""The log of a vehicle on several wheelsets, and its 3D scene."""
