"""The command group: sub-commands of this and other packages, common options, exit codes.

A package adds a sub-command by an entry point of the group "railpatch.commands" that names a click
command. --quiet and --version are added where the command has none of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path
from typing import Any

import click
from click.shell_completion import CompletionItem

from railpatch.errors import CaseError, ProfileError

ENTRY_POINT_GROUP = "railpatch.commands"
# sub-commands of this package that take long to import
ROOMS = {
    "bench": "evidence.bench",
    "continuity": "evidence.continuity",
    "convert": "convert",
    "export": "export",
    "figure": "report",
    "fmu": "fmu",
    "layout": "layout",
    "match": "match",
    "profile": "profiles.pairing",
    "report": "report",
    "stress": "evidence.stress",
    "subsurface": "below",
    "sweep": "sweep",
    "table": "evidence.table",
    "wear": "wear",
}
LAZY = {
    name: EntryPoint(name, f"railpatch.{room}.command:{name}", ENTRY_POINT_GROUP)
    for name, room in ROOMS.items()
}
EXIT_WRONG_CALL = 2
EXIT_NOT_CONVERGED = 3


class WrongCall(click.ClickException):
    """The call was wrong: the message goes to stderr, exit code 2."""

    exit_code = EXIT_WRONG_CALL


def wrong_call(error: Exception) -> WrongCall:
    """Of an error; of a file by its name."""
    if isinstance(error, OSError) and error.filename is not None:
        return WrongCall(f"{error.filename}: {error.strerror or error}")
    return WrongCall(str(error))


def print_version(context: click.Context, _option: click.Parameter, value: bool) -> None:
    """Prints the version and ends."""
    if not value or context.resilient_parsing:
        return
    from railpatch import __version__

    click.echo(f"railpatch {__version__}")
    context.exit()


def version_option() -> click.Option:
    """--version."""
    return click.Option(
        ["--version"],
        is_flag=True,
        is_eager=True,
        expose_value=False,
        callback=print_version,
        help="Print the version.",
    )


def quiet_option() -> click.Option:
    """--quiet for a command that has none."""
    return click.Option(["--quiet"], is_flag=True, expose_value=False, help="Print nothing.")


def completed(
    names: Callable[[], Iterable[str]],
) -> Callable[[click.Context, click.Parameter, str], list[str]]:
    """What a shell offers for a value: for ``shell_complete`` of an argument or option."""

    def complete(_context: click.Context, _of: click.Parameter, begun: str) -> list[str]:
        return [name for name in names() if name.startswith(begun)]

    return complete


def complete_file(
    _context: click.Context, _of: click.Parameter, begun: str
) -> list[CompletionItem]:
    """A shell's own completion of files: for ``shell_complete`` of a value NAME|FILE."""
    return [CompletionItem(begun, type="file")]


def scene_argument() -> Callable[..., Any]:
    """[SCENE.toml], a path or None."""
    return click.argument(
        "scene", metavar="[SCENE.toml]", required=False, type=click.Path(path_type=Path)
    )


def output_option(metavar: str, text: str, *, required: bool = True) -> Callable[..., Any]:
    """-o, --output: the file to write."""
    return click.option(
        "-o",
        "--output",
        required=required,
        type=click.Path(dir_okay=False, path_type=Path),
        metavar=metavar,
        help=text,
    )


def folder_option(text: str) -> Callable[..., Any]:
    """-o, --output: the folder to write to."""
    return click.option(
        "-o",
        "--output",
        required=True,
        type=click.Path(file_okay=False, path_type=Path),
        metavar="DIR",
        help=text,
    )


def json_option(text: str = "Print one JSON object.") -> Callable[..., Any]:
    """--json, as ``as_json``."""
    return click.option("--json", "as_json", is_flag=True, help=text)


def quiet_flag(text: str = "Print nothing.") -> Callable[..., Any]:
    """--quiet, of a command that has something to be quiet about."""
    return click.option("--quiet", is_flag=True, help=text)


def strict_flag() -> Callable[..., Any]:
    """--strict, of a command that has warnings."""
    return click.option(
        "--strict", is_flag=True, help="Warnings are errors: the call was wrong, exit code 2."
    )


def tell_warnings(texts: Iterable[str], *, strict: bool, quiet: bool) -> None:
    """Prints them to stderr. Raises WrongCall where they are errors."""
    lines = list(texts)
    if strict and lines:
        raise WrongCall("\n".join(f"{line} (--strict)" for line in lines))
    for line in lines:
        if not quiet:
            click.echo(f"warning: {line}", err=True)


def show_scene_option(
    text: Callable[[], str],
    told: str = "Print the scene that is run by default, as a start for one's own.",
) -> Callable[..., Any]:
    """--show-scene: prints the scene that is run by default and ends."""

    def show(context: click.Context, _option: click.Parameter, value: bool) -> None:
        if not value or context.resilient_parsing:
            return
        click.echo(text(), nl=False)
        context.exit()

    return click.option(
        "--show-scene",
        is_flag=True,
        is_eager=True,
        expose_value=False,
        callback=show,
        help=told,
    )


def need(module: str) -> None:
    """Raises WrongCall that says what to install where an optional part cannot be imported."""
    try:
        import_module(module)
    except ImportError as error:
        raise WrongCall(str(error)) from None


class NeedingCommand(click.Command):
    """A command that needs an optional part, and says so before it reads its options.

    needs: raises WrongCall where the part is missing, as need() does. Options that only tell
    something, --help or --version, and completion go without it.
    """

    def __init__(self, *arguments: Any, needs: Callable[[], None], **keywords: Any) -> None:
        super().__init__(*arguments, **keywords)
        self.needs = needs

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """The options, where the part is there."""
        telling = {
            name for option in self.get_params(ctx) if option.is_eager for name in option.opts
        }
        if not ctx.resilient_parsing and telling.isdisjoint(args):
            self.needs()
        return super().parse_args(ctx, args)


def need_pinocchio() -> None:
    """Raises WrongCall where Pinocchio is missing."""
    need("railpatch.pinocchio")


@contextmanager
def wrong_calls() -> Iterator[None]:
    """Errors of the case and of files end as those of a wrong call."""
    try:
        yield
    except (CaseError, ProfileError, OSError) as error:
        raise wrong_call(error) from None


@contextmanager
def progress_bar(label: str, total: int, quiet: bool) -> Iterator[Callable[[Any], None]]:
    """What to call after each step; a bar on stderr only where that is a terminal."""
    from rich.console import Console
    from rich.progress import MofNCompleteColumn, Progress

    console = Console(stderr=True)
    shown = console.is_terminal and not quiet
    columns = (*Progress.get_default_columns(), MofNCompleteColumn())
    with Progress(*columns, console=console, disable=not shown, transient=True) as bar:
        task = bar.add_task(label, total=total)
        yield lambda _step: bar.advance(task)


def with_common_options(command: click.Command) -> click.Command:
    """The command with --quiet and --version."""
    names = {parameter.name for parameter in command.params}
    for option in (quiet_option(), version_option()):
        if option.name not in names:
            command.params.append(option)
    return command


class Commands(click.Group):
    """The railpatch command with its own and other packages' sub-commands."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """All names, without importing other packages."""
        return sorted({*super().list_commands(ctx), *self._outside()})

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """A sub-command with the common options."""
        command = super().get_command(ctx, cmd_name)
        if command is None:
            entry = self._outside().get(cmd_name)
            if entry is None:
                return None
            command = load_entry(entry)
        return with_common_options(command)

    def invoke(self, ctx: click.Context) -> Any:
        """Runs the sub-command; errors of the call end with exit code 2."""
        try:
            return super().invoke(ctx)
        except (CaseError, ProfileError) as error:
            raise WrongCall(str(error)) from None
        except MemoryError as error:
            raise WrongCall(f"grid: {error or 'out of memory'}, allowed what fits") from None
        except BrokenPipeError:
            raise
        except OSError as error:
            # files that are named are refused where they are opened
            if error.filename is not None:
                raise wrong_call(error) from None
            raise WrongCall(f"output: cannot be written: {error.strerror or error}") from None

    @staticmethod
    def _outside() -> dict[str, EntryPoint]:
        found = {entry.name: entry for entry in entry_points(group=ENTRY_POINT_GROUP)}
        return {**found, **LAZY}


def load_entry(entry: EntryPoint) -> click.Command:
    """The command of an entry point; one that only tells why where it cannot be imported."""
    try:
        command = entry.load()
        if isinstance(command, click.Command):
            return command
        reason = f"{entry.value} is no click command"
    except (ImportError, AttributeError) as error:
        reason = str(error)

    def fail() -> None:
        raise click.ClickException(f"'{entry.name}' cannot be loaded: {reason}")

    return click.Command(entry.name, callback=fail, help=f"(cannot be loaded: {reason})")
