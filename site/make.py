#!/usr/bin/python3
"""Builds the documents as a site in build/site. ./bootstrap site installs what it needs and calls it.

The documents are written to be read in the repository, where they link to sources: here a link out of
docs/ leads to a page with the file's text. Links that lead nowhere end the build.
"""
import html
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys

PROJECT = pathlib.Path(__file__).resolve().parent.parent
PAGES = PROJECT / "build/site_pages"
KATEX = pathlib.Path("/usr/share/javascript/katex")  # Debian's libjs-katex
FONTS = pathlib.Path("/usr/share/fonts/truetype/katex")  # Debian's fonts-katex
LINK = re.compile(r"(\]\()((?:\.\./)+[^)#\s]+)((?:#[^)\s]*)?\))")
RENDER = r"""addEventListener("DOMContentLoaded", () => document.querySelectorAll(".arithmatex").forEach(
  e => renderMathInElement(e, {throwOnError: false, delimiters: [
    {left: "\\[", right: "\\]", display: true}, {left: "\\(", right: "\\)", display: false}]})));
"""


def adapt(document, linked):
    """The text of a document for the site; adds to `linked` what it links to outside docs/."""
    folder = posixpath.dirname(document.relative_to(PROJECT).as_posix())

    def rewritten(match):
        target = posixpath.normpath(posixpath.join(folder, match[2]))
        if target.startswith("docs/"):
            return match[0]
        if not (PROJECT / target).exists():
            sys.exit(f"{document}: a link leads nowhere: {match[2]}")
        linked.add(target)
        return f"{match[1]}{posixpath.relpath('docs/files/' + target + '.html', folder)})"

    return LINK.sub(rewritten, document.read_text())


def write_listing(target):
    """A file as a page of text; of a folder the names of what is in it."""
    source = PROJECT / target
    if source.is_dir():
        text = "\n".join(sorted(p.name for p in source.iterdir()))
    else:
        text = source.read_text(errors="replace")
    page = PAGES / "files" / (target + ".html")
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text(
        f"<!DOCTYPE html><meta charset=utf-8><title>{target}</title>"
        "<style>:root{color-scheme:light dark}pre{font:14px/1.4 monospace}</style>"
        f"<h1>{target}</h1><pre>{html.escape(text, quote=False)}</pre>\n")


def add_formulas():
    """KaTeX as files of the site; its style sheet asks for fonts beside it."""
    katex = PAGES / "katex"
    katex.mkdir()
    for name in ("katex.min.css", "katex.min.js", "contrib/auto-render.js"):
        shutil.copyfile(KATEX / name, katex / pathlib.Path(name).name)
    shutil.copytree(FONTS, katex / "fonts")
    (katex / "render.js").write_text(RENDER)


def main():
    shutil.rmtree(PAGES, ignore_errors=True)
    shutil.copytree(PROJECT / "docs", PAGES)
    linked = set()
    for document in sorted((PROJECT / "docs").rglob("*.md")):
        text = adapt(document, linked)
        (PAGES / document.relative_to(PROJECT / "docs")).write_text(text)
    for target in sorted(linked):
        write_listing(target)
    add_formulas()
    config = PROJECT / "site/mkdocs.yml"
    sys.exit(subprocess.run(["mkdocs", "build", "--strict", "--quiet", "-f", config]).returncode)


main()
