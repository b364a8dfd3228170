"""The run log: MCAP files of wheelset and roller-rig runs.

from railpatch.log import RunLog, SceneGeometry, read_run
"""

from .geometry import SceneGeometry, scene_geometry
from .reader import Attachment, Run, RunFileError, Series, read_run
from .writer import RunLog

__all__ = [
    "Attachment",
    "Run",
    "RunFileError",
    "RunLog",
    "SceneGeometry",
    "Series",
    "read_run",
    "scene_geometry",
]
