"""The commands of hybrid_rl, one line each."""

import ast
import sys
from pathlib import Path

MAIN = 'if __name__ == "__main__":'
FORMS = ("[a-z]*.py", "[a-z]*/__main__.py")  # files of a command


def commands() -> dict[str, str]:
    """Name of a command -> the first line of its docstring, without an import."""
    names = {}
    package = Path(__file__).parent
    homes = (package, package / "tools")
    for path in (found for home in homes for form in FORMS for found in home.glob(form)):
        text = path.read_text(encoding="utf-8")
        if MAIN in text:
            name = path.parent.name if path.stem == "__main__" else path.stem
            names[name] = (ast.get_docstring(ast.parse(text)) or "").splitlines()[0]
    return dict(sorted(names.items()))


def main() -> int:
    """Print the commands; exit code 2 where something else was asked for."""
    known = commands()
    asked = [text for text in sys.argv[1:] if text not in ("--help", "-h")]
    if asked:
        name = asked[0] if asked[0] in known else "COMMAND"
        line = f"{asked[0]}: write python -m hybrid_rl.{name}; COMMAND is one of"
        print(f"hybrid_rl: {line} {', '.join(known)}", file=sys.stderr)
        return 2
    width = max(map(len, known))
    for name, about in known.items():
        print(f"python -m hybrid_rl.{name:{width}}  {about}")
    print("\n--help after any of them shows its arguments.")
    return 0


if __name__ == "__main__":
    sys.exit(main())
