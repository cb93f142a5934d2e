"""Tables of Markdown, made by scripts, on pages written by hand."""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "runs"))

from next import fail  # noqa: E402


def line(cells):
    return "| " + " | ".join(cells) + " |"


def table(head, rows):
    """head: the first line, by which put() finds the table on a page. rows: cells of each."""
    return "\n".join([head, "|" + "---|" * (head.count("|") - 1), *map(line, rows)]) + "\n"


def put(text, made, page):
    """The text of a page with its tables as they are made. Ends with 2 where not just one line is the head of one."""
    for one in made:
        head = one.partition("\n")[0]
        if text.splitlines().count(head) != 1:
            fail(f"{page}: found no table with the line \"{head}\", or several")
        text = re.sub(rf"^{re.escape(head)}\n(\|.*\n)+", lambda _: one, text, flags=re.M)
    return text
