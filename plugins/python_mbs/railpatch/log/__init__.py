"""The run log: MCAP files of runs of a wheelset, the roller rig or a vehicle.

from railpatch.log import RunLog, SceneGeometry, read_run
"""

from railpatch.log.geometry import SceneGeometry, scene_geometry
from railpatch.log.reader import Attachment, Run, RunFileError, Series, read_run
from railpatch.log.vehicle.geometry import VehicleGeometry
from railpatch.log.vehicle.log import VehicleLog
from railpatch.log.writer import RunLog

__all__ = [
    "Attachment",
    "Run",
    "RunFileError",
    "RunLog",
    "SceneGeometry",
    "Series",
    "VehicleGeometry",
    "VehicleLog",
    "read_run",
    "scene_geometry",
]
