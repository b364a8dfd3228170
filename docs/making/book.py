"""The book of validation: every claim, what shows it, the command that makes it again.

    python -m making.book OUT.json            # from docs/: runs the quick ones
    python -m making.book OUT.json --all      # the long ones too: hours
    python -m making.book OUT.json --only "vehicle in a curve" --keep

The claims stand in claims.toml. What was run is written to OUT.json with date, commit and time, and
the page shows it. --only runs the claims whose titles hold the words and adds them to what OUT.json
has; --keep writes what is long into long_runs.json too, which is part of the checkout: the page
shows it where OUT.json has no later one. A claim that has neither shows the date and commit of its
last evidence.
"""

from __future__ import annotations

import argparse
import json
import re
import shlex
import subprocess
import sys
import time
from datetime import datetime, timezone
from functools import cache
from pathlib import Path
from typing import Any

from making import ROOT, Pages, cell, table

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

CLAIMS = Path(__file__).with_name("claims.toml")
RESULTS = ROOT / "build/book.json"
KEPT = Path(__file__).with_name("long_runs.json")
# s, beyond which a command is ended
LONGEST = 36000.0
# what commands print that is no result
NOISE = re.compile(r"^(\.+ *\[ *\d+%\]|rootdir|configfile|plugins|platform|collected|created|=+.*)")


def claims() -> list[dict[str, Any]]:
    """All claims, by chapter in order."""
    content = tomllib.loads(CLAIMS.read_text(encoding="utf-8"))
    return [{"chapter": c["title"], **claim} for c in content["chapter"] for claim in c["claim"]]


def argv(command: str) -> list[str]:
    """The command as it is run: by this interpreter and its railpatch."""
    words = shlex.split(command)
    known = {
        "python": sys.executable,
        "railpatch": str(Path(sys.executable).with_name("railpatch")),
    }
    return [known.get(words[0], words[0]), *words[1:]]


@cache
def commit(place: str = "") -> tuple[str, str]:
    """Date and commit that last changed a file of the checkout; of "" the checkout's own."""
    words = ["git", "-C", str(ROOT), "log", "-1", "--format=%cs %h", "--", *filter(None, [place])]
    found = subprocess.run(words, capture_output=True, text=True, check=False).stdout.split()
    return (found[0], found[1]) if len(found) == 2 else ("", "")


@cache
def changed() -> bool:
    """Whether the checkout holds more than its commit."""
    words = ["git", "-C", str(ROOT), "status", "--porcelain", "--untracked-files=no"]
    return bool(subprocess.run(words, capture_output=True, text=True, check=False).stdout)


def run(claim: dict[str, Any]) -> dict[str, Any]:
    """Runs a claim's command in the checkout."""
    begin = time.perf_counter()
    done = subprocess.run(
        argv(claim["command"]),
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
        timeout=LONGEST,
        stdin=subprocess.DEVNULL,
    )
    lines = [line for line in done.stdout.splitlines() if not NOISE.match(line)]
    now = datetime.now(timezone.utc)
    return {
        "command": claim["command"],
        "good": done.returncode == 0,
        "seconds": round(time.perf_counter() - begin, 1),
        "date": now.strftime("%Y-%m-%d"),
        "commit": commit()[1],
        "changed": changed(),
        "printed": "\n".join(lines[-60:]),
        "error": "" if done.returncode == 0 else (done.stderr or done.stdout)[-2000:],
    }


def read(place: Path) -> dict[str, dict[str, Any]]:
    """Runs by command, as they stand in a file; none where it is not there."""
    if not place.is_file():
        return {}
    return {one["command"]: one for one in json.loads(place.read_text(encoding="utf-8"))}


def write(place: Path, runs: dict[str, dict[str, Any]]) -> None:
    """Those of claims that there are, in the order of the book."""
    kept = [runs[claim["command"]] for claim in claims() if claim["command"] in runs]
    place.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")


def results() -> dict[str, dict[str, Any]]:
    """What was run, by command: in this checkout, or before and kept; the later of both."""
    runs = read(KEPT)
    for command, one in read(RESULTS).items():
        if command not in runs or runs[command]["date"] <= one["date"]:
            runs[command] = one
    return runs


def entry(claim: dict[str, Any], known: dict[str, dict[str, Any]]) -> list[str]:
    """Lines of one claim."""
    lines = [f"### {claim['title']}", "", claim["text"], ""]
    if "source" in claim:
        lines += [f"Source: {claim['source']}", ""]
    lines += [f"![{claim['title']}]({claim['figure']})", ""] if "figure" in claim else []
    lines += [f"Numbers: [{claim['page']}]({claim['page']}).", ""] if "page" in claim else []
    lines += [f"    {claim['command']}", ""]
    done = known.get(claim["command"])
    if done is None:
        date, which = commit(claim["evidence"])
        how = f"takes {claim['long']}" if "long" in claim else "`make book` runs it"
        lines += [f"Not run for this page ({how}); evidence of {date}, commit `{which}`.", ""]
    else:
        word = "Holds" if done["good"] else "**Does not hold**"
        more = " with changes that were not committed" if done["changed"] else ""
        when = f"{done['date']}, commit `{done['commit']}`{more}, {done['seconds']:g} s"
        lines += [f"{word}: {when}.", ""]
        shown = done["printed"].strip() or done["error"].strip()
        if claim.get("show") == "table" and done["good"]:
            lines += [shown, ""]
        elif shown and ("show" in claim or not done["good"]):
            lines += [f"```text\n{shown}\n```", ""]
    return lines


def anchor(title: str) -> str:
    """Where a claim stands on the page."""
    name = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
    return "#" + re.sub(r"-+", "-", name)


def pages() -> Pages:
    """The book."""
    known = results()
    lines = [
        "# Validation: the book",
        "",
        "Every claim with what shows it and the command that makes it again, from a checkout with"
        " `make setup`. `make book` runs all that are quick and builds this page anew; those that"
        " take long say so and are run one by one (`python -m making.book --only TITLE --keep` in"
        " docs/), with the date and commit of the last run kept. Tests are named where the numbers"
        " with their sources stand in them.",
        "",
    ]
    rows = []
    for claim in claims():
        done = known.get(claim["command"])
        state = "not run for this page"
        if done is not None:
            state = ("holds, " if done["good"] else "**does not hold**, ") + done["date"]
            state += f", `{done['commit']}`"
        link = f"[{cell(claim['title'])}]({anchor(claim['title'])})"
        rows.append([link, cell(claim["against"]), state])
    lines += [table(["claim", "against", "state"], rows), ""]
    chapter = None
    for claim in claims():
        if claim["chapter"] != chapter:
            chapter = claim["chapter"]
            lines += [f"## {chapter}", ""]
        lines += entry(claim, known)
    return {"book.md": "\n".join(lines)}


def main() -> int:
    """Runs the claims; 1 where one does not hold."""
    parser = argparse.ArgumentParser(prog="python -m making.book")
    parser.add_argument("output", nargs="?", type=Path, default=RESULTS, metavar="OUT.json")
    parser.add_argument("--all", action="store_true", help="the long ones too")
    parser.add_argument("--only", metavar="WORDS", help="claims whose titles have these words")
    parser.add_argument("--keep", action="store_true", help="what is long, in long_runs.json")
    options = parser.parse_args()
    wanted = [claim for claim in claims() if options.all or "long" not in claim]
    if options.only is not None:
        wanted = [claim for claim in claims() if options.only.lower() in claim["title"].lower()]
        if not wanted:
            parser.error(f"--only: no claim's title has {options.only!r}")
    options.output.parent.mkdir(parents=True, exist_ok=True)
    found = read(options.output) if options.only is not None else {}
    good = True
    for claim in wanted:
        done = run(claim)
        good = good and done["good"]
        found[claim["command"]] = done
        word = "holds" if done["good"] else "FAILS"
        print(f"{word:6} {done['seconds']:7.1f} s  {claim['title']}", flush=True)
        print(done["error"], end="")
        # at once: the next one may take hours
        write(options.output, found)
        if options.keep and "long" in claim:
            write(KEPT, {**read(KEPT), claim["command"]: done})
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
