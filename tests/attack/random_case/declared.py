"""The program's own declaration of its keys: what `grainfield keys --markdown` prints."""
import re
import subprocess
from dataclasses import dataclass, field


@dataclass
class Key:
    section: str
    name: str
    type: str
    defaults: dict  # study -> text; "": the others
    choices: list = field(default_factory=list)  # (word, dimension or 0)
    least: float = 0.0
    most: float = 0.0
    or_zero: bool = False
    studies: list = field(default_factory=list)
    needs: list = field(default_factory=list)  # (key, [values], [studies])
    space: bool = False  # three dimensions only

    @property
    def path(self):
        return f"{self.section}.{self.name}" if self.section else self.name

    def default(self, study):
        return value_of(self.defaults.get(study, self.defaults[""]))

    def words(self, dim):
        return [word for word, of in self.choices if of in (0, dim)]


def value_of(text):
    """A default as the table prints it, TOML, as a Python value; None where it follows other keys."""
    text = text.strip()
    if re.search(r"^from | of ", text) and not text.startswith('"'):
        return None
    if text.startswith("["):
        inner = text[1:-1].strip()
        return [value_of(item) for item in inner.split(",")] if inner else []
    if text.startswith('"'):
        return text[1:-1]
    if text in ("true", "false"):
        return text == "true"
    return float(text) if re.search(r"[.en]", text) else int(text)


def rows(text):
    """(section, its note, cells) of every row of the page's tables."""
    section, note = "", ""
    for line in text.splitlines():
        if line.startswith("## "):
            section, note = re.sub(r"[\[\]]", "", line[3:]).strip(), ""
            if section == "Top level":
                section = ""
        elif line.startswith("Studies: "):
            note = line[len("Studies: "):].rstrip(".")
        elif line.startswith("| `"):
            yield section, note, [c.strip() for c in re.split(r"(?<!\\)\|", line)[1:-1]]


def limits_of(key, allowed):
    allowed = allowed.replace("\\|", "|")
    if key.type.startswith(("word", "list of words")) and allowed != "any":
        for word in allowed.split(" | "):
            found = re.fullmatch(r"(\S+)(?: \((\d)D\))?", word.strip())
            key.choices.append((found[1], int(found[2] or 0)))
        return
    found = re.fullmatch(r"(0, or )?(\S+) to (\S+)", allowed)
    if found:
        key.or_zero = bool(found[1])
        key.least, key.most = float(found[2]), float(found[3])


def conditions_of(key, meaning, every):
    """Studies and choices that a key belongs to: what stands before its meaning."""
    found = re.match(r"([a-z-]+(?:, [a-z-]+)*): ", meaning)
    if found and all(name in every for name in found[1].split(", ")):
        key.studies = found[1].split(", ")
        meaning = meaning[found.end():]
    found = re.match(r"with ((?:3D|\w+\.\w+ = [^:]*?)(?:, \w+\.\w+ = [^:]*?)*): ", meaning)
    if not found:
        return
    for part in re.split(r", (?=\w+\.\w+ = )", found[1]):
        if part == "3D":
            key.space = True
            continue
        path, values = part.split(" = ", 1)
        studies = re.search(r" \(study ([^)]*)\)", values)
        values = re.sub(r" \(study [^)]*\)", "", values)
        key.needs.append((path, [value_of(v) if v in ("true", "false") or v[0].isdigit() else v
                                 for v in values.split(" or ")],
                          studies[1].split(", ") if studies else []))


def read_keys(text):
    table = list(rows(text))
    every = next(c[4] for _, _, c in table if c[0] == "`study`").replace("\\|", "|").split(" | ")
    out = {}
    for section, note, cells in table:
        name, kind, _, default, allowed, meaning = cells[:6]
        defaults = {}
        for k, part in enumerate(default.split("; ")):
            study, colon, text = part.partition(": ")
            defaults[study if k and colon else ""] = (text if k and colon else part).strip("`")
        key = Key(section, name.strip("`"), kind, defaults)
        key.studies = note.split(", ") if note else list(every)
        limits_of(key, allowed)
        conditions_of(key, meaning, every)
        out[key.path] = key
    return out


def declared_keys(program):
    text = subprocess.run([program, "keys", "--markdown"], check=True, capture_output=True,
                          text=True).stdout
    return read_keys(text)


def documented_figures(program):
    """(pattern, meaning) of the keys of summary.json."""
    text = subprocess.run([program, "keys", "--summary", "--markdown"], check=True,
                          capture_output=True, text=True).stdout
    out = []
    for _, _, cells in rows(text):
        pattern = re.escape(cells[0].strip("`")).replace(r"\*", r"[\w.+-]+?")
        out.append((re.compile(pattern + r"(\.[\w.+-]+)?"), cells[2]))
    return out
