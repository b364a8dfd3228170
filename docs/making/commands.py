"""The command line, from its parser: reference/commands.md."""

from __future__ import annotations

import inspect

import click
from railpatch.command.cli import cli

from making import Pages, cell, code, table


def commands(group: click.Group, prefix: str = "") -> dict[str, click.Command]:
    """All commands by name, also those of groups in the group."""
    context = click.Context(group)
    found: dict[str, click.Command] = {}
    for name in group.list_commands(context):
        command = group.get_command(context, name)
        assert command is not None, name
        found[prefix + name] = command
        if isinstance(command, click.Group):
            found |= commands(command, f"{prefix}{name} ")
    return found


def value_of(parameter: click.Parameter) -> str:
    """What follows an option."""
    if isinstance(parameter, click.Option) and (parameter.is_flag or parameter.count):
        return ""
    if parameter.metavar:
        return parameter.metavar
    if isinstance(parameter.type, click.Choice):
        return ", ".join(map(str, parameter.type.choices))
    return parameter.type.name.upper()


def default_of(parameter: click.Parameter) -> str:
    """What it is when it is not given."""
    if parameter.required:
        return "needed"
    value = parameter.default
    if value is None or callable(value) or type(value).__name__ == "Sentinel":
        return ""
    return "" if value is False or value == () else str(value)


def rows(command: click.Command) -> list[list[str]]:
    """Of all arguments and options."""
    found = []
    for parameter in command.get_params(click.Context(command)):
        if isinstance(parameter, click.Option):
            names = ", ".join([*parameter.opts, *parameter.secondary_opts])
            text = parameter.help or ""
        else:
            names, text = parameter.human_readable_name, ""
        many = " (several)" if parameter.multiple or parameter.nargs < 0 else ""
        found.append(
            [
                code(names),
                code(value_of(parameter)) + many,
                code(default_of(parameter)),
                cell(text),
            ]
        )
    return found


def pages() -> Pages:
    """The page of commands."""
    lines = ["# Commands", "", inspect.cleandoc(cli.help or ""), ""]
    lines += ["`railpatch COMMAND --help` prints what stands here.", ""]
    for name, command in commands(cli).items():
        pieces = command.collect_usage_pieces(click.Context(command))
        lines += [f"## railpatch {name}", "", f"    railpatch {name} {' '.join(pieces)}", ""]
        lines += [inspect.cleandoc(command.help or ""), ""]
        lines += [table(["option", "value", "default", "meaning"], rows(command)), ""]
    return {"reference/commands.md": "\n".join(lines)}
