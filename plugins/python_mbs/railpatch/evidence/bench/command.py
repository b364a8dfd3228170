"""The sub-command ``railpatch bench``."""

from __future__ import annotations

from pathlib import Path

import click

from railpatch.command.group import WrongCall, folder_option, progress_bar, quiet_flag
from railpatch.command.output import check_folder
from railpatch.evidence.ending import finish

ALL_SETS = "ABCDW"


@click.command("bench")
@folder_option("Folder for page, figures and tables.")
@click.option("--quick", is_flag=True, help="A part of everything, in about two minutes.")
@click.option(
    "--sets",
    default=ALL_SETS,
    show_default=True,
    help="Letters of the sets: A Hertzian, B non-elliptic, C sequences, D elastic layer, "
    "W a wheel on its rail.",
)
@click.option("--methods", metavar="NAME,...", help="Only these methods; all by default.")
@click.option(
    "--truth-file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE.npz",
    help="Another truth than that of the package.",
)
@click.option(
    "--truth",
    "only_truth",
    is_flag=True,
    help="Measure nothing: compute the truth (DIR/truth.npz), going on from what DIR holds.",
)
@click.option(
    "--jobs",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Processes, for --truth alone: run times are measured one after the other.",
)
@quiet_flag()
def bench(
    output: Path,
    quick: bool,
    sets: str,
    methods: str | None,
    truth_file: Path | None,
    only_truth: bool,
    jobs: int,
    quiet: bool,
) -> None:
    """Measure error against run time of every method, and report it.

    Errors are against the stored truth: fine grids of several discretisations, extrapolated.
    Run times are those of the library's steps on one core, without Python's.
    """
    if not sets or set(sets) - set(ALL_SETS) or len(set(sets)) != len(sets):
        raise WrongCall(f"--sets: value is {sets!r}, allowed letters of {ALL_SETS}, each once")
    check_folder(output)
    if only_truth:
        make_truth(output, sets, jobs, quiet)
    else:
        measure_all(output, quick, sets, methods, truth_file, quiet)


def make_truth(output: Path, sets: str, jobs: int, quiet: bool) -> None:
    """Computes the truth."""
    from railpatch.evidence.bench.truth import compute_truth, tasks

    with progress_bar("truth", len(tasks(sets)), quiet) as advance:
        path = compute_truth(output, sets, jobs, advance)
    if not quiet:
        click.echo(path)


def measure_all(
    output: Path,
    quick: bool,
    sets: str,
    methods: str | None,
    truth_file: Path | None,
    quiet: bool,
) -> None:
    """Measures and writes the report."""
    from railpatch.evidence.bench.files import write_report
    from railpatch.evidence.bench.methods import chosen_methods
    from railpatch.evidence.bench.picture import require_matplotlib
    from railpatch.evidence.bench.run import Plan, run_bench
    from railpatch.evidence.bench.terminal import print_report
    from railpatch.evidence.bench.truth import TruthFile

    try:
        require_matplotlib()
        truth = TruthFile(truth_file)
        plan = Plan(chosen_methods(methods), sets, quick)
    except (ValueError, KeyError, OSError, ImportError) as error:
        raise WrongCall(str(error)) from None
    with progress_bar("bench", plan.total, quiet) as advance:
        report = run_bench(plan, truth, advance)
    finish(report, output, write_report, print_report, quiet=quiet)
