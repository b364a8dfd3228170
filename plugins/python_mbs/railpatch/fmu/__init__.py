"""Makes an FMU (FMI 2.0) of a scene from libraries that were built before."""

from railpatch.fmu.pack import Backend, PackedFmu, pack_fmu

__all__ = ["Backend", "PackedFmu", "pack_fmu"]
