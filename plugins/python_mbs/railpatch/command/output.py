"""What a command writes, checked before it computes: no input is overwritten, the place exists."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from railpatch.command.group import WrongCall
from railpatch.page.browser import BrowserError, find_browser
from railpatch.page.printing import PDF

Name = str | os.PathLike[str] | None
PAGE = (".html", ".htm", ".pdf", "")
READ = {".toml": "the scene", ".mcap": "the log"}


def check_output(output: Path | None, *inputs: Name) -> None:
    """The file can be made and is none of the inputs, also not by another name. None: nothing is
    written, or not given. Raises WrongCall."""
    if output is None:
        return
    try:
        if output.is_dir() or not output.parent.is_dir():
            raise refusal(output, "a file in a folder that exists")
        refuse_same(output, *inputs)
        probe(output)
    except OSError as error:
        reason = error.strerror or error
        raise refusal(output, f"a file that can be written: {reason}") from None


def check_page(output: Path, *inputs: Name, others: tuple[str, ...] = ()) -> None:
    """As check_output, and the name is none of another format. others: endings of what the command
    writes besides pages, for the message. Raises WrongCall."""
    check_output(output, *inputs)
    if output.suffix.lower() not in PAGE and not output.is_char_device():
        raise refusal(output, f"a name that ends in {' or '.join(filter(None, (*PAGE, *others)))}")
    if output.suffix.lower() == PDF:
        try:
            find_browser()
        except BrowserError as error:
            raise WrongCall(str(error)) from None


def refuse_same(output: Path | None, *inputs: Name) -> None:
    """Raises WrongCall where the file to write is one that is read."""
    if output is None or not output.exists():
        return
    for name in inputs:
        if name is None or not is_file(Path(name)):
            continue
        if output.samefile(name):
            read = Path(name)
            what = READ.get(read.suffix, f"the input {read.name}")
            raise refusal(output, f"another file than {what}")


def check_folder(output: Path) -> None:
    """The folder can be made, and files in it. Raises WrongCall."""
    try:
        place = output.absolute()
        while not place.exists() and place != place.parent:
            place = place.parent
        with tempfile.TemporaryFile(dir=place):
            pass
    except OSError as error:
        reason = error.strerror or error
        raise refusal(output, f"a folder that can be written to: {reason}") from None


def refusal(output: Path, allowed: str) -> WrongCall:
    """Of a value of --output."""
    return WrongCall(f"--output: value is {str(output)!r}, allowed {allowed}")


def probe(path: Path) -> None:
    """Opens for writing as a run would, and leaves all as it was. Raises OSError."""
    if path.is_file():
        os.close(os.open(path, os.O_WRONLY))
    elif not path.exists() and not path.is_symlink():
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        path.unlink()


def files_of(content: Any, *folders: Path) -> list[Path]:
    """The files that the texts of a checked case name: profiles, gap, irregularity.

    folders: where relative ones are looked for, beside the working directory.
    """
    texts = list(texts_of(content.model_dump()))
    places = [folder / text for text in texts for folder in (Path(), *folders)]
    return [place for place in places if is_file(place)]


def is_file(path: Path) -> bool:
    """False also for a text that can be no file's name."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def texts_of(content: Any) -> Iterator[str]:
    """All of them, in tables and lists."""
    if isinstance(content, str):
        yield content
    elif isinstance(content, Mapping):
        for value in content.values():
            yield from texts_of(value)
    elif isinstance(content, Iterable):
        for value in content:
            yield from texts_of(value)
