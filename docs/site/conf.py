"""A site of all pages, by Sphinx and MyST (Debian: python3-myst-parser):

    sphinx-build -W -b html -c docs/site . results/site

The folder of the sources is the repository's, so that links lead where they do in it. MathJax draws
the formulas in the reader's browser, from the address that Sphinx has, or without a network from Debian's
libjs-mathjax: -D 'mathjax_path=file:///usr/share/javascript/mathjax/MathJax.js?config=TeX-AMS_HTML'.
"""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

project = "grainfield"
author = "The grainfield authors"
extensions = ["myst_parser", "sphinx.ext.mathjax"]
root_doc = "README"
include_patterns = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "docs/**"]
exclude_patterns = ["docs/site/**"]
source_suffix = {".md": "markdown"}
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_update_mathjax = False
html_theme = "alabaster"
html_title = "grainfield"
html_theme_options = {"page_width": "1280px"}
html_static_path = ["static"]
html_css_files = ["wide.css"]
html_show_copyright = False
highlight_language = "none"

# The order of the pages beside the text; those that no line names come last.
CHAPTERS = {
    "Start": ["docs/README", "docs/guide", "docs/tutorial-point-load", "docs/gallery", "docs/install", "docs/glossary",
              "docs/symbols", "docs/geotechnical", "docs/state-of-the-question"],
    "How to": ["docs/steps", "docs/howto", "docs/import", "docs/import-formats", "docs/averaging", "docs/strain",
               "docs/structure", "docs/elastic-constants", "docs/fits", "docs/comparison", "docs/experiments", "docs/python"],
    "Theory": ["docs/theory-*", "docs/verdict", "docs/statistics"],
    "Simulation": ["docs/piles", "docs/fields", "docs/contact-laws", "docs/shapes", "docs/integrators",
                   "docs/sleeping", "docs/collisions", "docs/quasistatic"],
    "Reference": ["docs/index", "docs/commands", "docs/keys", "docs/summary-keys", "docs/columns", "docs/file-formats",
                  "docs/reproduction", "docs/benchmarks", "docs/reliability"],
    "Studies": ["docs/cases/*"],
    "Project": ["docs/*", "docs/reproduction/results/*", "CONTRIBUTING", "CHANGELOG"],
}


def contents():
    """A tree of the pages for each chapter; each page is in one."""
    seen, out = set(), ""
    for chapter, patterns in CHAPTERS.items():
        pages = [str(p.relative_to(ROOT).with_suffix("")) for q in patterns for p in sorted(ROOT.glob(q + ".md"))]
        pages = [p for p in pages if not (p in seen or seen.add(p))]
        out += "\n```{toctree}\n:hidden:\n:maxdepth: 1\n:caption: " + chapter + "\n\n" + "\n".join(pages) + "\n```\n"
    return out


def adapt(app, name, source):
    """GitHub's ```math is MyST's ```{math}; no lexer reads ```csv; the front page has the contents."""
    text = re.sub(r"^```math$", "```{math}", source[0], flags=re.M)
    text = re.sub(r"^```csv.*$", "```", text, flags=re.M)
    source[0] = text + contents() if name == root_doc else text


def setup(app):
    app.connect("source-read", adapt)
