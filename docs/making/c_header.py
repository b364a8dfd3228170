"""The C interface and its texts, from the headers: reference/c_header.md, reference/messages.md."""

from __future__ import annotations

import re

from making import ROOT, Pages, cell, code, table

INCLUDE = ROOT / "core/include"
HEADER = INCLUDE / "railpatch.h"
FIELDS = INCLUDE / "railpatch_fields.h"
LISTS = {
    "RP_ERRORS": ("Errors", "The call was wrong: outputs are untouched, exit code 2."),
    "RP_STATUSES": ("Statuses", "The call was right; how the solve ended."),
    "RP_REASONS": ("Reasons", "Why a result is not good, with a number of what the text says."),
    "RP_WARNINGS": ("Warnings", "What can hardly be meant: bits of `warnings`."),
}
STRUCTS = {
    "RP_CONFIG_FIELDS": ("rp_config", "what a handle is made with"),
    "RP_INPUT_FIELDS": ("rp_input", "what a step is given"),
    "RP_RESULT_FIELDS": ("rp_result", "what a step returns"),
    "RP_SIDE_RESULT_FIELDS": ("rp_side_result", "of one wheel"),
    "RP_PATCH_RESULT_FIELDS": ("rp_patch_result", "of one contact patch"),
}


def macro(text: str, name: str) -> str:
    """The body of a list, its lines joined."""
    found = re.search(rf"^#define {name}\([^)]*\)((?:.*\\\n)*.*)$", text, re.MULTILINE)
    assert found, name
    return re.sub(r"/\*.*?\*/", " ", found[1].replace("\\\n", " "))


def arguments(body: str) -> list[tuple[str, list[str]]]:
    """Entries X(...), O(...) of a list with their arguments; strings are joined and unquoted."""
    found = []
    for begin in re.finditer(r"\b([XO])\(", body):
        depth, quoted, parts, part = 1, False, [], ""
        for mark in body[begin.end() :]:
            quoted ^= mark == '"'
            if not quoted:
                depth += (mark in "({") - (mark in ")}")
                if depth == 0:
                    break
                if mark == "," and depth == 1:
                    parts.append(part)
                    part = ""
                    continue
            part += mark
        found.append((begin[1], [unquoted(item) for item in [*parts, part]]))
    return found


def unquoted(text: str) -> str:
    """Adjacent strings of C as one, other text as it is."""
    strings = re.findall(r'"([^"]*)"', text)
    return "".join(strings) if strings or text.strip() == '""' else text.strip()


def functions(text: str) -> list[tuple[str, str, str]]:
    """Name, comment before, declaration of each function."""
    found = []
    for match in re.finditer(r"^RP_API ([^;]*?\b(rp_\w+)\([^;]*\));", text, re.MULTILINE):
        before = text[: match.start()].rstrip()
        comment = ""
        if before.endswith("*/"):
            comment = before[before.rindex("/*") + 2 : -2]
            # that of a whole line
            line = before[: before.rindex("/*")].rpartition("\n")[2]
            comment = "" if line.strip() else " ".join(re.sub(r"\n \*", "\n", comment).split())
        found.append((match[2], comment, " ".join(match[1].split())))
    return found


def header_page() -> str:
    """reference/c_header.md."""
    header = HEADER.read_text(encoding="utf-8")
    fields = FIELDS.read_text(encoding="utf-8")
    lines = ["# C header", "", "From `core/include/railpatch.h` and `railpatch_fields.h`.", ""]
    lines += ["## Functions", ""]
    for name, comment, declaration in functions(header):
        lines += [f"### {name}", "", f"```c\n{declaration};\n```", ""]
        lines += [cell(comment), ""] if comment else []
    for name, (struct, text) in STRUCTS.items():
        lines += [f"## {struct}", "", text.capitalize() + ".", ""]
        rows = []
        for mark, parts in arguments(macro(fields, name)):
            known = mark == "X"
            start = parts[-3] if known and len(parts) > 4 else ""
            rows.append(
                [
                    code(parts[1]),
                    code(parts[0]),
                    cell(parts[-2]) if known else "",
                    cell(parts[-1]) if known else f"{cell(start)}see the header",
                ]
            )
        lines += [table(["member", "type", "unit", "meaning"], rows), ""]
    lines += ["## Choices", ""]
    for list_name in re.findall(r"Y\(\w+, (RP_\w+)\)", fields):
        rows = [[code(p[0]), p[1], code(p[2])] for _, p in arguments(macro(header, list_name))]
        lines += [f"### {list_name}", "", table(["enumerator", "value", "word"], rows), ""]
    lines += ["## The header", "", f"```c\n{header}```", ""]
    return "\n".join(lines)


def messages_page() -> str:
    """reference/messages.md."""
    header = HEADER.read_text(encoding="utf-8")
    lines = [
        "# Errors, reasons, warnings",
        "",
        "The texts of the core. Errors of cases, files and options name the key, its value and what"
        " is allowed; [mistakes](../mistakes.md) has what is said of which, and"
        " [warnings](../warnings.md) where warnings and reasons stand.",
        "",
    ]
    for name, (title, text) in LISTS.items():
        rows = [[code(p[0]), p[1], cell(p[2]) or "none"] for _, p in arguments(macro(header, name))]
        lines += [f"## {title}", "", text, "", table(["in C", "number", "text"], rows), ""]
    lines += ["## Exceptions of Python", ""]
    from railpatch import errors

    rows = [
        [code(name), code(", ".join(base.__name__ for base in kind.__bases__)), cell(kind.__doc__)]
        for name, kind in vars(errors).items()
        if isinstance(kind, type) and issubclass(kind, Exception) and kind.__doc__
    ]
    lines += [table(["exception", "is a", "raised where"], rows), ""]
    return "\n".join(lines)


def pages() -> Pages:
    """Both pages."""
    return {"reference/c_header.md": header_page(), "reference/messages.md": messages_page()}
