"""Tables of a run log for other programs: CSV, Excel, MATLAB, Parquet.

from railpatch.export import write_table
"""

from railpatch.export.formats import write_table

__all__ = ["write_table"]
