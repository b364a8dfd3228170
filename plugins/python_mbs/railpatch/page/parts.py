"""What every page begins and ends with: a verdict, key numbers, and what is folded."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from html import escape

GOOD, DOUBT, BAD, PLAIN = "good", "doubt", "bad", "plain"
_WORDS = {GOOD: "within", BAD: "above", DOUBT: "near"}


@dataclass(frozen=True)
class Key:
    """A number that answers. value: with its unit. note: what it stands beside, a limit or what is
    expected. state: GOOD, DOUBT, BAD, or PLAIN where nothing judges it."""

    name: str
    value: str
    note: str = ""
    state: str = PLAIN


def opening(title: str, about: str, verdict: str, keys: Iterable[Key], state: str = PLAIN) -> str:
    """Title, a line on what was run, the verdict and the key numbers. Plain text all."""
    lines = [f"<h1>{escape(title)}</h1>"]
    if about:
        lines.append(f"<p class=sub>{escape(about)}</p>")
    lines.append(f'<p class="verdict {state}">{escape(verdict)}</p>')
    return "".join([*lines, key_numbers(keys)])


def key_numbers(keys: Iterable[Key]) -> str:
    """Cards beside each other."""
    cards = [
        f'<div class="key {key.state}"><dt>{breakable(key.name)}</dt><dd>{escape(key.value)}</dd>'
        + (f"<dd class=note>{escape(key.note)}</dd>" if key.note else "")
        + "</div>"
        for key in keys
    ]
    return f"<dl class=keys>{''.join(cards)}</dl>" if cards else ""


def breakable(name: str) -> str:
    """Names of outputs, right.damage.wear_rate, break between their words on narrow cards."""
    return re.sub(r"([._])(?=[A-Za-z])", r"\1<wbr>", escape(name))


def folded(title: str, html: str, *, open_: bool = False, on_paper: bool = False) -> str:
    """A section that is closed until it is wanted; empty where there is nothing in it.
    on_paper: whether it is printed though it is closed."""
    if not html:
        return ""
    marks = (" class=paper" if on_paper else "") + (" open" if open_ else "")
    return f"<details{marks}><summary>{escape(title)}</summary>{html}</details>"


def against(value: float, limit: float, text: str) -> tuple[str, str]:
    """Note and state of a number beside its limit: above it, within a tenth of it, or below."""
    state = BAD if value > limit else DOUBT if value > 0.9 * limit else GOOD
    return f"{_WORDS[state]} {text}", state
