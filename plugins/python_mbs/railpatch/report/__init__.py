"""The report of a run log: a self-contained HTML page.

from railpatch.report import write_report
"""

from railpatch.report.data import ReportError
from railpatch.report.page import write_report

__all__ = ["ReportError", "write_report"]
