"""Sizes in the core: no source file over 500 lines, no function over 80."""

from __future__ import annotations

import re
from pathlib import Path

CORE = Path(__file__).resolve().parents[2] / "core"
MOST_OF_A_FILE = 500
MOST_OF_A_FUNCTION = 80
# braces in which functions stand rather than statements
SCOPE = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b")
BEFORE_HEAD = re.compile(r"\s*((public|private|protected)\s*:\s*)*")
# in order: what may hold braces, quotes or semicolons that mean nothing
NO_CODE = re.compile(
    r'//[^\n]*|/\*.*?\*/|R"\((?:.*?)\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\''
    r"|^[ \t]*#(?:\\\n|[^\n])*",
    re.DOTALL | re.MULTILINE,
)

Function = tuple[str, int, int]  # head, first line, lines


def sources() -> dict[str, str]:
    """Path in the core -> text, but for .inc files, which hold numbers that a program wrote."""
    return {
        path.relative_to(CORE).as_posix(): path.read_text(encoding="utf-8")
        for path in sorted(CORE.rglob("*"))
        if path.suffix in {".cpp", ".hpp"}
    }


def without_comments(text: str) -> str:
    """The same lines without comments, strings and directives."""
    return NO_CODE.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)


def is_function(head: str) -> bool:
    """Of what stands before a brace outside functions: parameters, and no name of a scope."""
    plain = re.sub(r"\btemplate\s*<[^{;]*?>\s*(?=\w)", "", head)
    before, parenthesis, _ = plain.partition("(")
    return bool(parenthesis) and not SCOPE.search(before) and "=" not in before.split("operator")[0]


def functions(text: str) -> list[Function]:
    """Those at namespace and class level, from their heads to their ends."""
    code = without_comments(text)
    found: list[Function] = []
    scopes: list[bool] = []  # of each brace that is open: whether functions stand in it
    start = depth = begin = 0
    head = ""
    for at, sign in ((m.start(), m[0]) for m in re.finditer("[{};]", code)):
        if depth:  # in a function or in a list of values
            depth += (sign == "{") - (sign == "}")
            if depth == 0 and head:
                # a list of values among a constructor's initialisers is not its body
                if re.match(r"\s*[,{]", code[at + 1 :]) and re.search(r"\)\s*:", head):
                    continue
                first = code.count("\n", 0, begin) + 1
                found.append((head, first, code.count("\n", begin, at) + 1))
                head = ""
            if depth == 0:
                start = at + 1
        elif sign == "{":
            whole = code[start:at]
            if is_function(whole):
                lead = BEFORE_HEAD.match(whole)
                begin = start + (lead.end() if lead else 0)
                head = head or " ".join(code[begin:at].split())
                depth = 1
            elif SCOPE.search(whole):
                scopes.append(True)
                start = at + 1
            else:
                depth = 1
        elif sign == "}":
            assert scopes, f"a brace too many after {found[-1:]}"
            scopes.pop()
            start = at + 1
        elif sign == ";":
            start, head = at + 1, ""
    assert depth + len(scopes) == 0, f"a brace too few after {found[-1:]}"
    return found


def long_functions(texts: dict[str, str]) -> list[str]:
    """Each with its place and length."""
    return [
        f"{path}:{first}: {lines} lines in {head}"
        for path, text in texts.items()
        for head, first, lines in functions(text)
        if lines > MOST_OF_A_FUNCTION
    ]


def test_files() -> None:
    """What is longer is two things."""
    lengths = {path: text.count("\n") for path, text in sources().items()}
    assert len(lengths) > 100
    assert {path: n for path, n in lengths.items() if n > MOST_OF_A_FILE} == {}


def test_functions() -> None:
    """What is longer cannot be seen at once."""
    texts = sources()
    assert sum(len(functions(text)) for text in texts.values()) > 1000
    assert long_functions(texts) == []


PLAIN = """
namespace a {

// f() {
class b : public c<d> {
 public:
  explicit b(int n) : n_{n}, m_(n) { run("}", '{'); }
  template <class F>
  int run(F &&f) const {
    const auto g = [&] { return f(); };
    if (n_ > 0) {
      return g();
    }
    return 0;
  }
  int n_ = 0, m_{1};
};

const int table[] = {1, 2};
enum class e { one, two };
struct s {
  int v[2] = {0, 0};
} const *p;
bool operator==(const s &x, const s &y) {
  return x.v == y.v;
}
std::array<int, 2> made() { return {1, 2}; }

}  // namespace a
"""


def test_functions_are_found() -> None:
    """Bodies, not lists of values, not scopes, not comments."""
    found = [(head.partition("(")[0].split()[-1], lines) for head, _, lines in functions(PLAIN)]
    assert found == [("b", 1), ("run", 8), ("operator==", 3), ("made", 1)]


def test_a_long_function_is_named() -> None:
    """From its head to its closing brace."""
    lines = "\n".join("  go();" for _ in range(MOST_OF_A_FUNCTION - 2))
    texts = {"x.cpp": f"\nvoid f(int n) {{\n{lines}\n}}\n"}
    assert long_functions(texts) == []
    texts["x.cpp"] = texts["x.cpp"].replace("}", "  stop();\n}")
    assert long_functions(texts) == [f"x.cpp:2: {MOST_OF_A_FUNCTION + 1} lines in void f(int n)"]
