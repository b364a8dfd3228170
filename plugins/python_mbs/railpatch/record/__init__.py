"""Measured runs: files of any columns and units, checked and brought to SI.

from railpatch.record import read_record
"""

from railpatch.record.columns import Columns, MeasuredColumn
from railpatch.record.read import Record, read_record
from railpatch.record.resample import low_passed, resampled

__all__ = ["Columns", "MeasuredColumn", "Record", "low_passed", "read_record", "resampled"]
