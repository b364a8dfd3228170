"""The sub-command ``railpatch stress``."""

from __future__ import annotations

from pathlib import Path

import click

from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    WrongCall,
    folder_option,
    progress_bar,
    quiet_flag,
)
from railpatch.command.output import check_folder
from railpatch.evidence.ending import finish


@click.command("stress")
@folder_option("Folder for page and tables.")
@click.option("--quick", is_flag=True, help="Fewer of everything, in less than 20 s.")
@click.option("--seed", type=click.IntRange(min=0), help="Of the random mixtures.")
@click.option("--only", metavar="PATTERN", help='Part of "family: name, method"; * for anything.')
@quiet_flag()
@click.pass_context
def stress(
    context: click.Context,
    output: Path,
    quick: bool,
    seed: int | None,
    only: str | None,
    quiet: bool,
) -> None:
    """Solve stiff and extreme cases, and check every result by other code.

    Ends with exit code 3 where a result is at fault: no number, converged against the conditions of
    contact, too many iterations, no end.
    """
    from railpatch.evidence.stress.files import write_report
    from railpatch.evidence.stress.outcome import run_stress
    from railpatch.evidence.stress.plan import SEED, Plan
    from railpatch.evidence.stress.text import print_report

    plan = Plan(SEED if seed is None else seed, quick, only)
    if not len(plan):
        raise WrongCall(f"--only: value is {only!r}, allowed a part of a trial's name")
    check_folder(output)
    with progress_bar("stress", len(plan), quiet) as advance:
        report = run_stress(plan, advance)
    finish(report, output, write_report, print_report, quiet=quiet)
    if report.faults:
        context.exit(EXIT_NOT_CONVERGED)
