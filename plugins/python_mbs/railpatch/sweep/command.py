"""The sub-command ``railpatch sweep``."""

from __future__ import annotations

import json
import time
from collections import Counter
from importlib import resources
from pathlib import Path
from typing import Any

import click

from railpatch.command.ending import told_when_ended
from railpatch.command.group import (
    EXIT_NOT_CONVERGED,
    WrongCall,
    folder_option,
    json_option,
    progress_bar,
    quiet_flag,
    show_scene_option,
    strict_flag,
    tell_warnings,
    wrong_calls,
)
from railpatch.command.output import check_folder


def example_text() -> str:
    """A sweep to start from."""
    return resources.files("railpatch.sweep").joinpath("example.toml").read_text("utf-8")


@click.command("sweep")
@click.argument("sweep", metavar="SWEEP.toml", type=click.Path(path_type=Path))
@folder_option("Folder for results, page and what is needed to go on.")
@click.option(
    "--workers",
    type=click.IntRange(1, 1024),
    metavar="NUMBER",
    help="Processes on this machine, default 1; with --cluster jobs, default 4.",
)
@click.option("--scheduler", metavar="ADDRESS", help="Solve on the Dask cluster of a scheduler.")
@click.option(
    "--cluster", metavar="NAME", help="Start workers as batch jobs: slurm, pbs, sge, lsf, htcondor."
)
@json_option("Print a summary as one JSON object.")
@show_scene_option(example_text, "Print a sweep, as a start for one's own.")
@strict_flag()
@quiet_flag()
@click.pass_context
def sweep(
    context: click.Context,
    sweep: Path,
    output: Path,
    workers: int | None,
    scheduler: str | None,
    cluster: str | None,
    as_json: bool,
    strict: bool,
    quiet: bool,
) -> None:
    """Solve a scene for many values of its keys, here or on a cluster.

    What is done is kept as it is done: the same command goes on where it was ended. Ctrl-C ends it
    with exit code 130, SIGTERM with 143, and it says how many cases are kept. Cases without a good
    result are rows with status and reason, and exit code 3.
    """
    from railpatch.sweep.plan import load_plan
    from railpatch.sweep.run import kept_of, run_sweep

    if scheduler is not None and cluster is not None:
        raise WrongCall(f"--cluster: value is {cluster!r} with --scheduler, allowed one of them")
    if scheduler is not None and workers is not None:
        raise WrongCall(f"--workers: value is {workers} with --scheduler, allowed without")
    check_folder(output)
    plan = None

    def kept() -> str:
        return "no case was begun" if plan is None else kept_of(plan, output)

    with told_when_ended(kept), wrong_calls():
        plan = load_plan(sweep)
        backend = backend_of(scheduler, cluster, workers)
        count = workers or 1
        if not quiet and not as_json:
            click.echo(f"{'scene':<14}{plan.table.scene} ({plan.kind})")
            click.echo(f"{'cases':<14}{len(plan.points)}")
        with progress_bar("solving", len(plan.points), quiet) as advance:
            tell = Told(len(plan.points), advance)
            found = run_sweep(plan, output, workers=count, backend=backend, progress=tell)
    if as_json:
        click.echo(json.dumps(summary_of(found), allow_nan=False))
    elif not quiet:
        show(found)
    warned = Counter(text for row in found.rows for text in row.warnings)
    lines = [
        f"{text}; in {count} case{'s' if count > 1 else ''}" for text, count in warned.most_common()
    ]
    lines += [f"outputs: no case has {name!r}" for name in found.never()]
    tell_warnings(lines, strict=strict, quiet=quiet)
    if found.failed:
        if not quiet:
            first = found.rows[found.failed[0]]
            click.echo(
                f"status: {len(found.failed)} of {len(found.rows)} cases have no good result; the "
                f"first, number {found.failed[0]}: {first.status}: {first.reason}",
                err=True,
            )
        context.exit(EXIT_NOT_CONVERGED)


def backend_of(scheduler: str | None, cluster: str | None, workers: int | None) -> Any:
    """What solves chunks elsewhere; None for this machine. Raises CaseError."""
    if scheduler is None and cluster is None:
        return None
    from railpatch.sweep.cluster import batch_system, dask_backend
    from railpatch.sweep.cluster import scheduler as client_of

    connect = client_of(scheduler) if scheduler else batch_system(str(cluster), workers or 4)
    return dask_backend(connect, tell=lambda text: click.echo(text, err=True))


class Told:
    """Moves a bar to the number of cases that are done."""

    def __init__(self, count: int, advance: Any) -> None:
        self.count, self.advance, self.done = count, advance, 0
        self.begin = time.perf_counter()

    def __call__(self, done: int, count: int) -> None:
        """done: of ``count`` cases."""
        for _ in range(done - self.done):
            self.advance(None)
        self.done = done


def summary_of(found: Any) -> dict[str, Any]:
    """For JSON."""
    statuses = Counter(row.status for row in found.rows)
    return {
        "scene": found.plan.table.scene,
        "kind": found.plan.kind,
        "cases": len(found.rows),
        "statuses": dict(statuses),
        "reused": found.reused,
        "solved": found.solved,
        "wall_time": found.wall_time,
        "files": [str(path) for path in found.written],
    }


def show(found: Any) -> None:
    """A few lines."""
    statuses = Counter(row.status for row in found.rows)
    shown = ", ".join(f"{count} {status}" for status, count in statuses.most_common())
    click.echo(f"{'statuses':<14}{shown}")
    rate = found.solved / found.wall_time if found.wall_time > 0 else 0.0
    click.echo(
        f"{'solved now':<14}{found.solved} in {found.wall_time:.3g} s, {rate:.4g} cases/s; "
        f"{found.reused} were there"
    )
    for path in found.written:
        click.echo(f"{'file':<14}{path}")
