"""The documentation: links lead somewhere, every page is in the site, the reference holds all that
its sources have, and every example runs."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from pathlib import Path
from posixpath import normpath
from typing import Any

import click
import pytest
import railpatch
from railpatch.case.kinds import kind_of, kinds
from railpatch.command.cli import cli

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))

from making import book, links, reference, tutorials  # noqa: E402

LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)#\s]+)(?:#[^)\s]*)?\)|!\[[^\]]*\]\(([^)\s]+)\)")
FENCE = re.compile(r"^```.*?^```", re.DOTALL | re.MULTILINE)
PAGES = [
    ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md",
    *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "examples").glob("*.md")),
    ROOT / "core/README.md", ROOT / "plugins/python_mbs/README.md",
]  # fmt: skip


@pytest.fixture(scope="module")
def made() -> dict[str, str]:
    return reference.pages()


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    text = FENCE.sub("", page.read_text(encoding="utf-8"))
    targets = [a or b for a, b in LINK.findall(text)]
    local = [t for t in targets if "://" not in t and not t.startswith("mailto:")]
    assert [t for t in local if not (page.parent / t).exists()] == []


@pytest.mark.parametrize("script", tutorials.scripts(), ids=lambda s: s.stem)
def test_links_of_examples_hold_in_checkout_and_site(made: dict[str, str], script: Path) -> None:
    text = "\n".join(cell.source for cell in tutorials.cells(script) if cell.is_text)
    targets = [t for t, _ in LINK.findall(text) if "://" not in t]
    assert targets
    assert [t for t in targets if not (script.parent / t).exists()] == []
    page = f"tutorials/{script.stem}.md"
    led = [t for t, _ in LINK.findall(links.led(text, page)) if "://" not in t]
    assert len(led) == len(targets)
    pages = {normpath(f"tutorials/{t}") for t in led}
    known = {p.name for p in (ROOT / "docs").glob("*.md")} | set(made)
    assert pages - known == set()


def test_every_page_is_in_the_site() -> None:
    """As mkdocs warns, which `make docs` takes for an error; known here without it."""
    named = set(re.findall(r": ([\w/.]+\.md)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE))
    assert {page.name for page in (ROOT / "docs").glob("*.md")} <= {*named, "index.md"}
    scripts = {f"tutorials/{script.stem}.md" for script in tutorials.scripts()}
    assert scripts == {name for name in named if name.startswith("tutorials/")}
    assert {name for name in named if name.startswith("reference/keys/")} == {
        f"reference/keys/{kind}.md" for kind in [*kinds(), "match"]
    }


def leaves(schema: dict[str, Any], known: dict[str, Any]) -> Iterator[str]:
    """Names of the keys of a JSON schema, of all its tables."""
    if "$ref" in schema:
        name = schema["$ref"].rpartition("/")[2]
        if name in known:
            yield from leaves(known.pop(name), known)
        return
    for key, part in schema.get("properties", {}).items():
        yield key
        yield from leaves(part, known)
    for word in ("anyOf", "oneOf", "allOf"):
        for part in schema.get(word, []):
            yield from leaves(part, known)
    if isinstance(schema.get("items"), dict):
        yield from leaves(schema["items"], known)


@pytest.mark.parametrize("kind", kinds())
def test_every_key_is_in_the_reference(made: dict[str, str], kind: str) -> None:
    schema = kind_of(kind).schema()
    keys = set(leaves(schema, dict(schema.get("$defs", {}))))
    assert len(keys) > 5
    page = made[f"reference/keys/{kind}.md"] + made["reference/keys/match.md"]
    assert {key for key in keys if not re.search(rf"(?<!\w){re.escape(key)}(?!\w)", page)} == set()


def test_every_command_and_option_is_in_the_reference(made: dict[str, str]) -> None:
    page, context = made["reference/commands.md"], click.Context(cli)
    sections = dict(part.split("\n", 1) for part in page.split("\n## railpatch ")[1:])
    assert set(sections) == set(cli.list_commands(context))
    for name, text in sections.items():
        command = cli.get_command(context, name)
        assert command is not None
        options = {o for p in command.params if isinstance(p, click.Option) for o in p.opts}
        assert {o for o in options if o not in text} == set(), name


def test_every_function_and_class_is_in_the_reference(made: dict[str, str]) -> None:
    page = made["reference/python/railpatch.md"]
    names = [n for n in railpatch.__all__ if n[0] != "_"]
    assert [name for name in names if name not in page] == []
    header = (ROOT / "core/include/railpatch.h").read_text(encoding="utf-8")
    declared = set(re.findall(r"^RP_API [^(;]*?\b(rp_\w+)\(", header, re.MULTILINE))
    assert len(declared) > 20
    assert {name for name in declared if name not in made["reference/c_header.md"]} == set()


def test_claims_have_evidence() -> None:
    """Of each claim the file and the page that it names are there, and its command can be run."""
    for claim in book.claims():
        assert (ROOT / claim["evidence"]).exists(), claim["title"]
        if "page" in claim:
            assert (ROOT / "docs" / claim["page"].partition("#")[0]).is_file(), claim["title"]
        words = book.argv(claim["command"])
        if words[1:3] == ["-m", "pytest"]:
            named = [w for w in words[3:] if w.startswith("tests/")]
            assert named, claim["title"]
            assert all((ROOT / name.partition("::")[0]).exists() for name in named), claim["title"]
        elif words[1].endswith(".py"):
            assert (ROOT / words[1]).is_file(), claim["title"]
    assert "| claim | against | state |" in book.pages()["book.md"]


def test_every_figure_and_program_of_the_pages_is_in_the_book() -> None:
    """What docs/ draws or computes is a claim, beside the command that makes it again."""
    claims = book.claims()
    drawn = {claim["figure"] for claim in claims if "figure" in claim}
    assert {page.name for page in (ROOT / "docs").glob("*.svg")} == drawn
    commands = " ".join(claim["command"] for claim in claims)
    programs = {f"docs/{page.name}" for page in (ROOT / "docs").glob("*.py")}
    assert {one for one in programs if one not in commands} == set()
    titles = [claim["title"] for claim in claims]
    assert len(set(titles)) == len(titles)
    assert len({claim["command"] for claim in claims}) == len(titles)


def a_run(command: str, date: str, printed: str = "") -> dict[str, Any]:
    return {
        "command": command, "good": True, "seconds": 7.0, "date": date, "commit": date[-2:],
        "changed": False, "printed": printed, "error": "",
    }  # fmt: skip


def test_long_claims_are_kept_and_shown_with_date_and_commit(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    long = [claim for claim in book.claims() if "long" in claim]
    kept, made, out = long[0]["command"], long[1]["command"], tmp_path / "book.json"
    monkeypatch.setattr(book, "KEPT", tmp_path / "kept.json")
    monkeypatch.setattr(book, "RESULTS", out)
    monkeypatch.setattr(book, "run", lambda claim: a_run(claim["command"], "2026-02-03"))
    title = long[0]["title"]
    monkeypatch.setattr(sys, "argv", ["book", str(out), "--only", title, "--keep"])
    assert book.main() == 0
    book.write(out, {made: a_run(made, "2026-03-04")})
    page = book.pages()["book.md"]
    assert f"({book.anchor(title)}) | {long[0]['against']} | holds, 2026-02-03, `03` |" in page
    assert "Holds: 2026-03-04, commit `04`, 7 s." in page
    # the later of both
    book.write(out, {kept: a_run(kept, "2026-01-01")})
    assert "2026-01-01" not in book.pages()["book.md"]
    book.write(out, {kept: a_run(kept, "2026-05-06")})
    assert "Holds: 2026-05-06" in book.pages()["book.md"]


def test_kept_runs_are_those_of_claims() -> None:
    """Of each the command is a claim's that is long, and the commit one of this checkout's kind."""
    long = {claim["command"] for claim in book.claims() if "long" in claim}
    for command, one in book.read(book.KEPT).items():
        assert command in long, command
        assert one["good"], one["error"]
        assert re.fullmatch(r"[0-9a-f]{7,12}", one["commit"])
        assert re.fullmatch(r"\d{4}-\d\d-\d\d", one["date"])
        assert not re.search(r"(^|\s)/(tmp|home|root|work)", one["printed"]), command


@pytest.mark.parametrize("script", tutorials.scripts(), ids=lambda s: s.stem)
def test_examples_run(script: Path) -> None:
    shown = tutorials.run(script)
    assert any(one.printed for one in shown)
    # text that tells, and a figure or numbers after it
    assert sum(cell.is_text for cell in tutorials.cells(script)) >= 3
